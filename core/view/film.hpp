// A film of drawings: a video that ffmpeg encodes, or numbered PNG pictures.
#pragma once
#include <cstdint>
#include <memory>
#include <optional>
#include <string>

#include "core/view/drawing.hpp"
#include "core/view/video_frame.hpp"
#include "hal/output_file.hpp"
#include "hal/program.hpp"
#include "hal/result.hpp"

namespace tandem::core {

struct FilmConfig {
  std::string path;  ///< FILE.mp4, .mkv or .webp; FOLDER/ or FOLDER/NAME%06d.png
  double frames_per_second = 25.0;
  PictureLook look;
};

/// All frames have the size of the first one. One thread at a time may use it.
class Film {
 public:
  /// Whether a film of this name can be made: ending, ffmpeg, the renderer. To be asked before a run.
  static hal::Status can_make(const std::string& path);
  /// Error: as above, or the file or folder cannot be written.
  static hal::Result<std::unique_ptr<Film>> open(const FilmConfig& config);
  /// Without `close` nothing of a video stays; pictures do.
  ~Film() = default;

  /// Adds a frame. Error: the disk is full, or ffmpeg has ended; with its words. Nothing is added any more.
  hal::Status add(const Drawing& drawing);
  /// Puts the film in its place. Error: as `add`.
  hal::Status close();
  std::int64_t frames() const noexcept { return frames_; }
  /// What there is to know when it is whole, such as pictures of an older film behind the last one; empty: nothing.
  std::string remark() const;

 private:
  Film() = default;
  hal::Status add_picture(const std::string& svg);
  hal::Status add_to_video(const std::string& svg);
  hal::Status start_encoder();
  std::string picture_path(std::int64_t frame) const;

  FilmConfig config_;
  std::string before_, after_;  // of names of pictures, around the number
  int digits_ = 0;              // of the number; 0: a video
  std::optional<hal::OutputFile> file_;
  std::unique_ptr<hal::Program> encoder_;
  VideoFrame frame_;
  std::string pixels_, before_pixels_;  // as rendered: of this frame, and of the one before
  std::int64_t frames_ = 0;
};

}  // namespace tandem::core
