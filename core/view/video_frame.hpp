// One frame as encoders take it: planes of brightness and colours.
#pragma once
#include <cstdint>
#include <string>
#include <string_view>

namespace tandem::core {

/// 4:2:0 planes as ITU-R BT.601 has them, 16 to 235 and 16 to 240: brightness of each pixel, then blueness and redness
/// of each square of four. Sides are even, a line more than the pixels' where those are odd.
class VideoFrame {
 public:
  /// Takes over `pixels`, which are PictureFormat::Pixels; only what differs from `before`, the pixels of the last
  /// call, is converted. False: they have another size than the first ones, and nothing is taken.
  bool show(const std::string& pixels, const std::string& before);

  std::uint32_t width() const noexcept { return width_; }
  std::uint32_t height() const noexcept { return height_; }
  std::string_view planes() const noexcept { return planes_; }

 private:
  void convert(const std::uint8_t* pixels, std::uint32_t x, std::uint32_t y);

  std::uint32_t pixels_wide_ = 0, pixels_high_ = 0;
  std::uint32_t width_ = 0, height_ = 0;
  std::string planes_;
};

}  // namespace tandem::core
