// Rings of sensors and lamps for data sheets.
#pragma once
#include <array>
#include <cmath>
#include <numbers>

#include "hal/elementary.hpp"
#include "hal/spec/data_sheet.hpp"

namespace tandem::hal {

/// `count` mounts in a ring, counter-clockwise, evenly spread, the first `first_deg` from forward. Directions are
/// worked out when the program starts: sine and cosine are no constant expressions.
template <std::size_t count>
std::array<Mount, count> ring_of(double first_deg, double radius_m, double height_m) {
  std::array<Mount, count> mounts;
  for (std::size_t i = 0; i < count; ++i) {
    const double turn = (first_deg + 360.0 / count * static_cast<double>(i)) / 180.0;
    const double bearing = turn > 1.0 ? turn - 2.0 : turn;  // half turns, in (-1, 1]
    const double rad = bearing * std::numbers::pi;
    mounts[i] = {rad, radius_m * cos(rad), radius_m * sin(rad), height_m};
  }
  return mounts;
}

}  // namespace tandem::hal
