// Interface of a source of frames: a camera, a film, a folder of pictures, a pipe.
#pragma once
#include <cstdint>
#include <memory>
#include <string>

#include "bridges/frames/frame.hpp"
#include "hal/result.hpp"

namespace tandem::bridges::frames {

struct SourceOptions {
  /// In real time: pictures at `rate_hz`, films at their own rate. False: as fast as they are taken.
  bool live = true;
  double rate_hz = 0.0;               ///< of pictures (0: 15) and cameras (0: theirs)
  std::size_t width = 0, height = 0;  ///< of a camera's frames; 0: its own
};

/// One thread at a time.
class FrameSource {
 public:
  enum class Got { Frame, Nothing, Over };
  virtual ~FrameSource() = default;
  /// Waits for the next frame, no longer than `timeout_ms`. Nothing: there is none yet, which `trouble` may explain.
  virtual Got next(Frame& frame, int timeout_ms) = 0;
  /// Pieces of the stream that were no frames, so far.
  virtual std::uint64_t malformed() const { return 0; }
  /// What is wrong; empty: nothing is known to be.
  virtual std::string trouble() const { return {}; }
};

/// `what`: "camera:DEVICE" (V4L2) and "film:FILE" by ffmpeg, "folder:FOLDER" of PNG and PGM pictures in the order of
/// their names, "pipe:FILE" of tandem-frames, Y4M or PGM; a FILE that there is not becomes a named pipe. Errors: none
/// of these, no such file, no ffmpeg.
hal::Result<std::unique_ptr<FrameSource>> open_frames(const std::string& what, const SourceOptions& options);
/// The errors of `open_frames`, without opening anything.
hal::Status check_frames(const std::string& what);

}  // namespace tandem::bridges::frames
