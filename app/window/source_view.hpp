// Shows a space to the viewers of a window, whether of a run or of a record: poses, layers, robots from the inside.
#pragma once
#include <chrono>
#include <cstdint>
#include <functional>
#include <string>
#include <vector>

#include "core/view/layers/layer_set.hpp"
#include "hal/catalog.hpp"
#include "hal/json/json.hpp"
#include "hal/log.hpp"
#include "window/space_frame.hpp"
#include "window/window.hpp"

namespace tandem::app {

/// Used by one thread.
class SourceView {
 public:
  /// Gives the message "inspection" of these robots, but for its type.
  using Inspect = std::function<hal::Json(const std::vector<std::string>&)>;

  /// With the layers of the catalog, which must outlive this.
  explicit SourceView(const hal::Catalog& catalog, hal::Log log = {}) : layers_(catalog, std::move(log)) {}

  /// "layers" of the message "hello".
  hal::Json layers_json(const core::Space& space) const;
  /// Whether `note` is to be called.
  bool notes() const noexcept { return layers_.any_on(); }
  /// After every tick, for layers that depend on the past.
  void note(const core::Observation& now) { layers_.note(now); }
  /// Shows what viewers wish for, as it is after `done` ticks. @param settled nothing moves: it may stay for long
  void show(window::Window& window, const core::Observation& now, hal::Tick done, bool settled, const Inspect& inspect);

 private:
  using Clock = std::chrono::steady_clock;
  void apply_wishes(window::Window& window);

  core::LayerSet layers_;
  window::SpaceFrames frames_;
  std::vector<std::size_t> layers_shown_;
  std::uint64_t wishes_ = 0;
  std::vector<std::string> inspected_, states_;
  Clock::time_point inspection_told_;
};

}  // namespace tandem::app
