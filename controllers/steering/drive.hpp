// Wheel speeds that lead to a bearing.
#pragma once
#include <algorithm>
#include <cmath>

#include "hal/device/wheels.hpp"

namespace tandem::controllers {

/// Drives with `speed_m_s` towards a bearing (counter-clockwise from forward): along an arc where it is ahead, on the
/// spot and at half the speed while it is more than `aside_rad` to the side. No wheel is faster than `speed_m_s`.
inline void drive_towards(hal::WheelSpeeds& wheels, double bearing_rad, double speed_m_s,
                          double aside_rad = 0.6) noexcept {
  if (std::fabs(bearing_rad) > aside_rad) {
    const double rim_m_s = std::copysign(0.5 * speed_m_s, bearing_rad);
    wheels.set(-rim_m_s, rim_m_s);
    return;
  }
  const double slower = 1.0 - std::min(1.0, std::fabs(bearing_rad));
  wheels.set(bearing_rad > 0.0 ? slower * speed_m_s : speed_m_s, bearing_rad > 0.0 ? speed_m_s : slower * speed_m_s);
}

/// Turns on the spot by what is left of a turn. @returns whether less than `enough_rad` is left
inline bool turn_by(hal::WheelSpeeds& wheels, double left_rad, double rim_m_s, double enough_rad = 0.1) noexcept {
  const bool there = std::fabs(left_rad) < enough_rad;
  const double rim = there ? 0.0 : std::copysign(rim_m_s, left_rad);
  wheels.set(-rim, rim);
  return there;
}

}  // namespace tandem::controllers
