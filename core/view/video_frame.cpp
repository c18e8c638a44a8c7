#include "core/view/video_frame.hpp"

#include <algorithm>
#include <array>
#include <cstddef>
#include <cstring>

namespace tandem::core {
namespace {

constexpr std::size_t kHead_bytes = 8;  // width and height before the pixels
constexpr std::size_t kPixel_bytes = 4;

bool same_pair(const char* a, const char* b) {
  std::uint64_t one = 0, other = 0;
  std::memcpy(&one, a, sizeof one);
  std::memcpy(&other, b, sizeof other);
  return one == other;
}

// ITU-R BT.601, in parts of 2^16, with the half that rounds.
char brightness(int b, int g, int r) {
  return static_cast<char>((6416 * b + 33039 * g + 16829 * r + (16 << 16) + 32768) >> 16);
}
char blueness(int b, int g, int r) {
  return static_cast<char>((28784 * b - 19071 * g - 9713 * r + (128 << 16) + 32768) >> 16);
}
char redness(int b, int g, int r) {
  return static_cast<char>((-4681 * b - 24103 * g + 28784 * r + (128 << 16) + 32768) >> 16);
}

}  // namespace

bool VideoFrame::show(const std::string& pixels, const std::string& before) {
  std::array<std::uint32_t, 2> size{};
  std::memcpy(size.data(), pixels.data(), kHead_bytes);
  const bool first = planes_.empty();
  if (first) {
    pixels_wide_ = size[0];
    pixels_high_ = size[1];
    width_ = (size[0] + 1) / 2 * 2;
    height_ = (size[1] + 1) / 2 * 2;
    planes_.resize(std::size_t{width_} * height_ * 3 / 2);
  }
  if (size[0] != pixels_wide_ || size[1] != pixels_high_) return false;
  const auto* const now = reinterpret_cast<const std::uint8_t*>(pixels.data() + kHead_bytes);
  const std::size_t line = kPixel_bytes * pixels_wide_;
  const char *const here = pixels.data() + kHead_bytes, *const old = before.data() + kHead_bytes;
  const auto same_line = [&](std::size_t at) { return !first && std::memcmp(here + at, old + at, line) == 0; };
  for (std::uint32_t y = 0; y < height_; y += 2) {
    const std::size_t above = y * line, beneath = std::min(y + 1, pixels_high_ - 1) * line;
    if (same_line(above) && same_line(beneath)) continue;
    for (std::uint32_t x = 0; x < width_; x += 2) {
      const std::size_t a = above + kPixel_bytes * x, b = beneath + kPixel_bytes * x;
      const bool whole = !first && x + 1 < pixels_wide_;
      if (whole && same_pair(here + a, old + a) && same_pair(here + b, old + b)) continue;
      convert(now, x, y);
    }
  }
  return true;
}

/// The square of four pixels whose first is (x, y); the last line and column stand for those behind them.
void VideoFrame::convert(const std::uint8_t* pixels, std::uint32_t x, std::uint32_t y) {
  std::array<int, 3> sum{};
  for (std::uint32_t i = 0; i < 4; ++i) {
    const std::uint32_t column = x + i % 2, line = y + i / 2;
    const std::uint8_t* const p =
        pixels + kPixel_bytes * (std::size_t{std::min(line, pixels_high_ - 1)} * pixels_wide_ +
                                 std::min(column, pixels_wide_ - 1));
    planes_[std::size_t{line} * width_ + column] = brightness(p[0], p[1], p[2]);
    for (std::size_t color = 0; color < sum.size(); ++color) sum[color] += p[color];
  }
  const std::size_t square = std::size_t{y / 2} * (width_ / 2) + x / 2;
  const std::size_t all = std::size_t{width_} * height_;
  for (int& color : sum) color = (color + 2) / 4;
  planes_[all + square] = blueness(sum[0], sum[1], sum[2]);
  planes_[all + all / 4 + square] = redness(sum[0], sum[1], sum[2]);
}

}  // namespace tandem::core
