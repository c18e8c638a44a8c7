// A colour of a light.
#pragma once
#include <cstdint>

namespace tandem::hal {

/// 8 bits a channel. A robot whose LEDs have one colour lights them when any channel is above half.
struct Rgb {
  std::uint8_t r = 0, g = 0, b = 0;
  friend bool operator==(const Rgb&, const Rgb&) = default;
};

/// Whether both may be one light, as a camera shows its colour and as it was set.
constexpr bool alike(Rgb a, Rgb b) noexcept {
  constexpr int kMost = 64;
  const auto near = [](int one, int other) { return one - other < kMost && other - one < kMost; };
  return near(a.r, b.r) && near(a.g, b.g) && near(a.b, b.b);
}

inline constexpr Rgb kBlack{0, 0, 0};
inline constexpr Rgb kRed{255, 0, 0};
inline constexpr Rgb kGreen{0, 255, 0};
inline constexpr Rgb kBlue{0, 0, 255};
inline constexpr Rgb kWhite{255, 255, 255};

}  // namespace tandem::hal
