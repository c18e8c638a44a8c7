// Wheels of robots, for engines that let them drive.
#pragma once
#include <algorithm>
#include <cmath>

#include "core/space/stores.hpp"
#include "hal/robot_kind.hpp"

namespace tandem::core {

/// The wheels of a kind of robot. One that does not move by itself stands on brakes.
inline const hal::DifferentialDrive& wheels_of(const hal::RobotKind& kind) noexcept {
  if (const hal::DifferentialDrive* drive = kind.drive(); drive != nullptr) return *drive;
  static const hal::DifferentialDrive brakes{.wheel_base_m = 1.0, .force_N = 1e3, .torque_Nm = 1e3};
  return brakes;
}

/// The most that a wheel of the block's robots turns with: the kind's limit, or, of a kind without, their command.
inline double top_wheel_m_s(const SpaceStores& stores, const RobotBlock& block) noexcept {
  const hal::DifferentialDrive& wheels = wheels_of(*stores.groups[block.group].kind);
  if (wheels.limited()) return wheels.max_speed_m_s;
  const Bodies& b = stores.bodies;
  double most_m_s = 0.0;
  for (std::size_t row = block.first_row; row < block.first_row + block.used; ++row)
    most_m_s = std::max({most_m_s, std::fabs(b.left_m_s[row]), std::fabs(b.right_m_s[row])});
  return std::min(most_m_s, wheels.max_speed_m_s);  // hooks may write anything
}

}  // namespace tandem::core
