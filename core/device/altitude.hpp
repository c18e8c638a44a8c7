// Distances straight down and straight up from a robot.
#pragma once
#include <limits>

#include "core/space/stores.hpp"

namespace tandem::core {

inline constexpr double kNothing_m = std::numeric_limits<double>::infinity();

/// How high the ceiling over a robot is: the top of the arena, or of the region that it is in. Infinite without one.
double ceiling_m(const SpaceStores& stores, std::size_t row) noexcept;

/// From the middle of a robot's base straight down to ground or object, or to another robot's top where `bodies`. Never
/// negative.
double room_below_m(const SpaceStores& stores, std::size_t row, bool bodies) noexcept;

/// From the middle of a robot's top straight up to ceiling, object, or another robot's base. Never negative.
double room_above_m(const SpaceStores& stores, std::size_t row) noexcept;

}  // namespace tandem::core
