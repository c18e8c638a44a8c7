// Rings of sensors and lamps for kinds of robots.
#pragma once
#include <cstddef>
#include <numbers>
#include <vector>

#include "hal/elementary.hpp"
#include "hal/robot_kind.hpp"

namespace tandem::hal {

/// `count` mounts in a ring, counter-clockwise, evenly spread, the first `first_deg` from forward.
inline std::vector<Mount> ring_of(std::size_t count, double first_deg, double radius_m, double height_m) {
  std::vector<Mount> mounts;
  for (std::size_t i = 0; i < count; ++i) {
    const double turn = (first_deg + 360.0 / static_cast<double>(count) * static_cast<double>(i)) / 180.0;
    const double bearing = turn > 1.0 ? turn - 2.0 : turn;  // half turns, in (-1, 1]
    const double rad = bearing * std::numbers::pi;
    mounts.push_back({rad, radius_m * cos(rad), radius_m * sin(rad), height_m});
  }
  return mounts;
}

}  // namespace tandem::hal
