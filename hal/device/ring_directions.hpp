// Unit vectors of a ring's bearings, worked out once for all controllers of robots with the same ring.
#pragma once
#include <algorithm>
#include <array>
#include <cmath>
#include <list>
#include <mutex>
#include <span>
#include <vector>

#include "hal/elementary.hpp"
#include "hal/robot_kind.hpp"

namespace tandem::hal {

/// Unit vectors in which the sensors of a ring look, in the body frame (x forward, y left). Entries beyond the ring are
/// 0.
struct RingDirections {
  static constexpr std::size_t kCapacity = 24;
  std::array<float, kCapacity> x{};
  std::array<float, kCapacity> y{};
};

/// The directions of `mounts`; the reference stays valid until the program or plug-in ends. Thread-safe; for
/// constructors, not for steps.
inline const RingDirections& ring_directions(std::span<const Mount> mounts) {
  struct Known {
    std::vector<double> bearings_rad;
    RingDirections directions;
  };
  static std::mutex guard;
  static std::list<Known> known;
  const std::lock_guard lock(guard);
  for (const Known& k : known) {
    const auto same = [](double bearing_rad, const Mount& m) { return bearing_rad == m.bearing_rad; };
    if (std::ranges::equal(k.bearings_rad, mounts, same)) return k.directions;
  }
  Known& made = known.emplace_back();
  for (const Mount& m : mounts) made.bearings_rad.push_back(m.bearing_rad);
  for (std::size_t i = 0; i < mounts.size() && i < RingDirections::kCapacity; ++i) {
    made.directions.x[i] = static_cast<float>(cos(mounts[i].bearing_rad));
    made.directions.y[i] = static_cast<float>(sin(mounts[i].bearing_rad));
  }
  return made.directions;
}

}  // namespace tandem::hal
