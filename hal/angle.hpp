// Angles, in radians.
#pragma once
#include <cmath>
#include <numbers>

namespace tandem::hal {

/// The same direction in (-pi, pi].
inline double wrapped(double angle_rad) noexcept {
  const double turned = std::remainder(angle_rad, 2.0 * std::numbers::pi);  // exact, so the same everywhere
  return turned <= -std::numbers::pi ? std::numbers::pi : turned;
}

/// The turn that leads from one direction to the other the shorter way, in (-pi, pi]; counter-clockwise is positive.
inline double turn_between(double from_rad, double to_rad) noexcept {
  return wrapped(to_rad - from_rad);
}

}  // namespace tandem::hal
