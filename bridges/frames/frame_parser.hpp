// Finds frames in a stream of bytes: `tandem-frames`, Y4M or PGM (docs/trackers.md). What comes is not believed: after
// bytes that are no frame it goes on with the next beginning of one.
#pragma once
#include <cstddef>
#include <cstdint>
#include <span>
#include <string>
#include <vector>

#include "bridges/frames/frame.hpp"

namespace tandem::bridges::frames {

class FrameParser {
 public:
  /// The next bytes of the stream.
  void add(std::span<const std::byte> bytes);
  /// Fills `frame` with the next one, but for when it was received. False: it is not all there yet.
  bool next(Frame& frame);
  /// The stream starts again.
  void reset();

  /// Places where there was no frame, so far.
  std::uint64_t malformed() const noexcept { return malformed_; }
  /// Why there was none at the last of them.
  const std::string& trouble() const noexcept { return trouble_; }

 private:
  enum class Found { Frame, Header, Nothing, Malformed };
  struct Y4m {
    std::size_t width = 0, height = 0, chroma_bytes = 0;
  };

  std::size_t left() const noexcept { return bytes_.size() - at_; }
  bool begins_with(const char* text) const noexcept;
  Found read(Frame& frame);
  Found read_own(Frame& frame);
  Found read_pgm(Frame& frame);
  Found read_y4m_header();
  Found read_y4m_frame(Frame& frame);
  Found malformed(const std::string& why);
  bool fits(std::size_t width, std::size_t height) const noexcept;
  void take(Frame& frame, std::size_t width, std::size_t height, std::size_t from);
  void look_on();

  std::vector<std::uint8_t> bytes_;
  std::size_t at_ = 0;  // where what has not been used begins
  bool in_y4m_ = false;
  Y4m y4m_;
  bool lost_ = false;  // looking for a beginning
  std::uint64_t malformed_ = 0;
  std::string trouble_;
};

}  // namespace tandem::bridges::frames
