// Text of SVG documents.
#pragma once
#include <charconv>
#include <cmath>
#include <numbers>
#include <string>
#include <string_view>

#include "hal/markup.hpp"
#include "hal/rgb.hpp"

namespace tandem::core {

/// Text of an SVG document, appended to piece by piece. Numbers get at most four decimals.
class Svg {
 public:
  Svg& operator<<(std::string_view text) {
    out_ += text;
    return *this;
  }
  Svg& operator<<(double value) {
    const double rounded = std::round(value * 1e4) / 1e4;
    char digits[40];
    const auto end = std::to_chars(digits, digits + sizeof digits, rounded == 0.0 ? 0.0 : rounded).ptr;
    out_.append(digits, end);
    return *this;
  }
  Svg& operator<<(std::size_t value) {
    out_ += std::to_string(value);
    return *this;
  }
  std::string take() { return std::move(out_); }

 private:
  std::string out_;
};

/// Without control characters.
inline std::string escaped(std::string_view text) {
  std::string kept(text);
  std::erase_if(kept, [](char c) { return static_cast<unsigned char>(c) < 0x20; });
  return hal::escaped_markup(kept);
}

inline std::string hex(hal::Rgb c) {
  constexpr std::string_view kDigits = "0123456789abcdef";
  std::string out = "#";
  for (const std::uint8_t v : {c.r, c.g, c.b}) {
    out += kDigits[v >> 4];
    out += kDigits[v & 15U];
  }
  return out;
}

inline double degrees(double rad) {
  return rad * 180.0 / std::numbers::pi;
}

}  // namespace tandem::core
