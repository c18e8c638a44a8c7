// Wheels of robots, for engines that let them drive.
#pragma once
#include "hal/robot_kind.hpp"

namespace tandem::core {

/// The wheels of a kind of robot. One that does not move by itself stands on brakes.
inline const hal::DifferentialDrive& wheels_of(const hal::RobotKind& kind) noexcept {
  if (const hal::DifferentialDrive* drive = kind.drive(); drive != nullptr) return *drive;
  static const hal::DifferentialDrive brakes{.wheel_base_m = 1.0, .force_N = 1e3, .torque_Nm = 1e3};
  return brakes;
}

}  // namespace tandem::core
