// Pictures on the way and films, of a run or of a record.
#pragma once
#include <atomic>
#include <cstdint>
#include <memory>
#include <string>

#include "app/run_options.hpp"
#include "core/view/drawing.hpp"
#include "core/view/layers/layer_set.hpp"
#include "core/view/trails.hpp"
#include "hal/catalog.hpp"
#include "hal/output_file.hpp"
#include "hal/result.hpp"

namespace tandem::app {

/// Whether pictures and films of these names can be made here. Error: an ending that is not known; a program that is
/// not installed, and how to install it.
hal::Status check_pictures(const PictureRequest& request);

/// Error: the region is none, or lies outside of the arena.
hal::Result<core::PictureLook> look_of(const PictureRequest& request, const core::PictureLook::Area& arena);

/// "end.svg", 100: "end-000100.svg".
std::string picture_at(const std::string& picture, std::int64_t ticks_done);

/// "view.png": "view.pov"; a scene's own name stays.
std::string scene_of(const std::string& povray);

/// Writes the scene to `file`, commits it, and renders it where `povray` ends in .png.
hal::Status write_scene(const core::Drawing& drawing, const core::PictureLook& look, hal::OutputFile& file,
                        const std::string& povray);

/// The layers over pictures; null: none are asked for. Error: there is none of a name, or it draws nothing.
hal::Result<std::unique_ptr<core::LayerSet>> layers_of(const PictureRequest& request, const hal::Catalog& catalog);
/// Adds what they show.
void draw_layers(core::LayerSet& layers, const core::Observation& now, core::Drawing& drawing);

/// Draws on a thread of its own. The caller waits when that is far behind: no frame is left out, until
/// `stop` is set: then what is not drawn yet is left out, and the film ends there.
class Pictures {
 public:
  /// Whether there is anything to be drawn before the end.
  static bool asked(const PictureRequest& request) noexcept;
  /// `ticks` are to come; 0: unknown. Error: a film of too many frames, a tick that does not come, or a file that
  /// cannot be written. `stop` must outlive this.
  static hal::Result<std::unique_ptr<Pictures>> open(const PictureRequest& request, const core::PictureLook& look,
                                                     std::int64_t ticks_per_second, std::int64_t ticks,
                                                     const std::atomic<bool>& stop);
  ~Pictures();

  /// After every tick, for the trails; also before the first one, with 0.
  void note(std::int64_t ticks_done, const core::Space& space) { trails_.note(ticks_done, space); }
  const core::Trails& trails() const noexcept { return trails_; }
  /// Whether `draw` is to be called after so many ticks.
  bool wants(std::int64_t ticks_done) const noexcept;
  void draw(std::int64_t ticks_done, core::Drawing drawing);
  /// Ticks that were done when the last picture that is ready was handed over.
  std::int64_t drawn_until() const;
  /// Waits until all is drawn. A failure is reported at once; @returns whether nothing has.
  bool close();

 private:
  struct Impl;
  explicit Pictures(core::Trails trails);

  core::Trails trails_;
  std::unique_ptr<Impl> impl_;
};

}  // namespace tandem::app
