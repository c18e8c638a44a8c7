// The last look at a command before a robot, real or simulated, gets it.
#pragma once
#include <algorithm>
#include <cmath>

#include "hal/device/distance_scanner.hpp"
#include "hal/device/flight.hpp"
#include "hal/device/gripper.hpp"
#include "hal/device/pan_tilt.hpp"
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

/// Leans, turn rates and thrusts are clamped; a command that is not finite becomes the safe one.
inline FilterResult filter(QuadrotorAttitude& command, double most_lean_rad, double most_turn_rad_s,
                           double most_thrust) noexcept {
  if (!std::isfinite(command.roll_rad) || !std::isfinite(command.pitch_rad) || !std::isfinite(command.yaw_rad_s) ||
      !std::isfinite(command.thrust)) {
    command = QuadrotorAttitude{};
    return FilterResult::NotFinite;
  }
  const QuadrotorAttitude before = command;
  command.roll_rad = std::clamp(command.roll_rad, -most_lean_rad, most_lean_rad);
  command.pitch_rad = std::clamp(command.pitch_rad, -most_lean_rad, most_lean_rad);
  command.yaw_rad_s = std::clamp(command.yaw_rad_s, -most_turn_rad_s, most_turn_rad_s);
  command.thrust = std::clamp(command.thrust, 0.0, most_thrust);
  const bool same = command.roll_rad == before.roll_rad && command.pitch_rad == before.pitch_rad &&
                    command.yaw_rad_s == before.yaw_rad_s && command.thrust == before.thrust;
  return same ? FilterResult::Passed : FilterResult::Clamped;
}

/// Speeds are clamped to [0, limit]; an order with a speed that is not finite, or that is none, becomes the safe one.
inline FilterResult filter(FlightTask& command, double limit_m_s) noexcept {
  if (!std::isfinite(command.speed_m_s) || command.order > FlightOrder::Detach) {
    command = FlightTask{};
    return FilterResult::NotFinite;
  }
  if (command.speed_m_s >= 0.0 && command.speed_m_s <= limit_m_s) return FilterResult::Passed;
  command.speed_m_s = std::clamp(command.speed_m_s, 0.0, limit_m_s);
  return FilterResult::Clamped;
}

/// Tilts are clamped to what the head reaches; angles that are not finite make it look straight down.
inline FilterResult filter(PanTiltDrive& command, double most_tilt_rad) noexcept {
  if (!std::isfinite(command.pan_rad) || !std::isfinite(command.tilt_rad)) {
    command = PanTiltDrive{};
    return FilterResult::NotFinite;
  }
  if (std::fabs(command.tilt_rad) <= most_tilt_rad) return FilterResult::Passed;
  command.tilt_rad = std::clamp(command.tilt_rad, -most_tilt_rad, most_tilt_rad);
  return FilterResult::Clamped;
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
