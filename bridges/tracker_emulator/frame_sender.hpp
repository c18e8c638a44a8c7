// Where an emulated camera's frames go: a pipe, or pictures in a folder.
#pragma once
#include <cstddef>
#include <cstdint>
#include <memory>
#include <string>
#include <vector>

#include "hal/result.hpp"

namespace tandem::bridges::tracker_emulator {

/// Where messages go.
class Sender {
 public:
  virtual ~Sender() = default;
  virtual void send(const std::vector<std::byte>& message) = 0;
};

bool sends_frames(const std::string& link) noexcept;
/// "pipe:FILE", which is made where there is none, takes frames as tandem-frames while it is read;
/// "folder:FOLDER" gets a PGM of each. The caller's process must ignore SIGPIPE. Errors: neither can be made.
hal::Result<std::unique_ptr<Sender>> open_frame_sender(const std::string& link);

/// A frame as tandem-frames.
std::vector<std::byte> frame_message(std::size_t width, std::size_t height, std::int64_t stamp_ns,
                                     const std::vector<std::uint8_t>& grey);

}  // namespace tandem::bridges::tracker_emulator
