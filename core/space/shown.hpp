// Robots in a space that belongs to no world: of a record, or a real one alone. Who fills the space says where they
// are.
#pragma once
#include <cstddef>
#include <cstdint>

#include "core/space/stores.hpp"
#include "hal/time.hpp"

namespace tandem::core {

/// Where a robot was seen. In W.
struct SeenPose {
  double x_m = 0.0, y_m = 0.0, z_m = 0.0, heading_rad = 0.0;
  hal::Tick tick = kNever;

  static constexpr hal::Tick kNever = -2;
};

/// Robot number `robot` lives in that slot, whose group has its kind. `real`: it stands for a real one.
void show_robot(SpaceStores& stores, std::uint32_t robot, Slot slot, bool real);

/// Puts the body there, upright. Its velocities are those since `was`, a second ago at most, else 0; `was` is then
/// `now`.
void show_body(SpaceStores& stores, std::size_t row, const SeenPose& now, std::int64_t ticks_per_second, SeenPose& was);

}  // namespace tandem::core
