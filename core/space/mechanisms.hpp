// What turns on robots and what they hold. Angles are relative to the body, counter-clockwise from forward.
#pragma once
#include <cmath>
#include <cstdint>
#include <numbers>

#include "hal/device/distance_scanner.hpp"
#include "hal/device/turret.hpp"

namespace tandem::core {

/// A turret: what it was told, and where it is.
struct TurretState {
  hal::TurretMode mode = hal::TurretMode::Off;
  double target = 0.0;  ///< Speed: rad/s; Position: rad
  double angle_rad = 0.0;
  double speed_rad_s = 0.0;  ///< over the last tick
};

/// A gripper. What it holds is joined to the turret that it sits on.
struct GripState {
  static constexpr std::uint32_t kNothing = 0xFFFF'FFFFU;

  double aperture_rad = 0.0;
  bool wants = false;              ///< the claws are open: they hold what is there
  bool slips = false;              ///< … but fail to in this tick
  std::uint32_t joint = kNothing;  ///< index into SpaceStores::joints
  std::uint32_t generation = 0;    ///< of that joint
  double turn_rad = 0.0;           ///< the turret's angle less the heading of what is held, relative to the robot's
  std::uint32_t grips = 0;         ///< times that something was gripped

  bool holding() const noexcept { return joint != kNothing; }
};

/// A distance scanner.
struct ScannerState {
  hal::ScannerMode mode = hal::ScannerMode::Off;
  double angle_rad = 0.0;
  double swept_rad = 0.0;  ///< in the last tick
};

/// What the wheels rolled beyond what their encoders can see.
struct HiddenRoll {
  double left_m = 0.0, right_m = 0.0;  ///< since the start
  double left_m_s = 0.0, right_m_s = 0.0;
};

/// The same direction, in (-pi, pi].
inline double wrapped(double angle_rad) noexcept {
  const double turned = std::remainder(angle_rad, 2.0 * std::numbers::pi);
  return turned <= -std::numbers::pi ? std::numbers::pi : turned;
}

}  // namespace tandem::core
