// The last look at a command before a robot, real or simulated, gets it.
#pragma once
#include <algorithm>
#include <cmath>

#include "hal/device/distance_scanner.hpp"
#include "hal/device/flight.hpp"
#include "hal/device/gripper.hpp"
#include "hal/device/turret.hpp"
#include "hal/device/wheels.hpp"

namespace tandem::hal {

enum class FilterResult { Passed, Clamped, NotFinite };

/// Speeds beyond `limit_m_s` are clamped, both by the same factor so that the curve driven stays the same; a command
/// that is not finite becomes the safe one.
inline FilterResult filter(WheelSpeeds& command, double limit_m_s) noexcept {
  const double left = std::fabs(command.left_m_s);
  const double right = std::fabs(command.right_m_s);
  if (left <= limit_m_s && right <= limit_m_s) return FilterResult::Passed;  // false when either is NaN
  if (!std::isfinite(left) || !std::isfinite(right)) {
    command = WheelSpeeds{};
    return FilterResult::NotFinite;
  }
  const double scale = limit_m_s / std::max(left, right);
  command.left_m_s *= scale;
  command.right_m_s *= scale;
  return FilterResult::Clamped;
}

/// Velocities longer than `limit_m_s` are shortened along their direction, turn rates clamped; a command that is not
/// finite becomes the safe one, which is to hover.
inline FilterResult filter(QuadrotorSpeed& command, double limit_m_s, double limit_rad_s) noexcept {
  const auto& v = command.velocity;
  // Not by hypot: GCC 12's form of three arguments overlooks what is no number.
  const double speed = std::sqrt(v[0] * v[0] + v[1] * v[1] + v[2] * v[2]);
  const double turn = std::fabs(command.yaw_rad_s);
  if (speed <= limit_m_s && turn <= limit_rad_s) return FilterResult::Passed;  // false when any is NaN
  if (!std::isfinite(v[0]) || !std::isfinite(v[1]) || !std::isfinite(v[2]) || !std::isfinite(turn)) {
    command = QuadrotorSpeed{};
    return FilterResult::NotFinite;
  }
  if (!(speed <= limit_m_s)) {
    // In two steps: the length of what is finite need not be.
    const double largest = std::max({std::fabs(v[0]), std::fabs(v[1]), std::fabs(v[2])});
    for (double& c : command.velocity) c /= largest;
    const double scale = limit_m_s / std::hypot(v[0], v[1], v[2]);
    for (double& c : command.velocity) c *= scale;
  }
  command.yaw_rad_s = std::clamp(command.yaw_rad_s, -limit_rad_s, limit_rad_s);
  return FilterResult::Clamped;
}

/// A target that is not finite becomes the safe command, which is to hover; also one that is on hold.
inline FilterResult filter(QuadrotorPosition& command) noexcept {
  bool finite = std::isfinite(command.yaw_rad);
  for (const double c : command.target) finite = finite && std::isfinite(c);
  if (finite) return FilterResult::Passed;
  command = QuadrotorPosition{};
  return FilterResult::NotFinite;
}

/// Speeds are clamped; a command that is not finite, or of no known mode, becomes the safe one. For what turns about
/// the robot's axis: turret and distance scanner.
template <class Drive, class Mode>
FilterResult filter_turn(Drive& command, Mode last_mode, double limit_rad_s) noexcept {
  if (!std::isfinite(command.speed_rad_s) || !std::isfinite(command.angle_rad) || command.mode > last_mode) {
    command = Drive{};
    return FilterResult::NotFinite;
  }
  if (std::fabs(command.speed_rad_s) <= limit_rad_s) return FilterResult::Passed;
  command.speed_rad_s = std::clamp(command.speed_rad_s, -limit_rad_s, limit_rad_s);
  return FilterResult::Clamped;
}
inline FilterResult filter(TurretDrive& command, double limit_rad_s) noexcept {
  return filter_turn(command, TurretMode::Position, limit_rad_s);
}
inline FilterResult filter(ScannerDrive& command, double limit_rad_s) noexcept {
  return filter_turn(command, ScannerMode::Position, limit_rad_s);
}

/// Apertures beyond what the claws reach are clamped; one that is not finite becomes the safe one, which lets go.
inline FilterResult filter(GripperDrive& command) noexcept {
  if (std::fabs(command.aperture_rad) <= GripperDrive::kMost_rad) return FilterResult::Passed;
  if (!std::isfinite(command.aperture_rad)) {
    command = GripperDrive{};
    return FilterResult::NotFinite;
  }
  command.aperture_rad = std::clamp(command.aperture_rad, -GripperDrive::kMost_rad, GripperDrive::kMost_rad);
  return FilterResult::Clamped;
}

}  // namespace tandem::hal
