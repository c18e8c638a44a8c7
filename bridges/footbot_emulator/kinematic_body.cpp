#include "bridges/footbot_emulator/kinematic_body.hpp"

#include <algorithm>
#include <limits>
#include <numbers>

#include "hal/angle.hpp"
#include "hal/device/distance_scanner.hpp"
#include "hal/device/turret.hpp"

namespace tandem::bridges::footbot_emulator {
namespace {

constexpr hal::TimeNs kStepNs = 10 * hal::kNsPerMs;
constexpr hal::TimeNs kTryNs = hal::kNsPerSecond;  // a grip is tried for up to so long
constexpr double kClaws_rad_s = std::numbers::pi;  // wide open in half a second

/// From `angle_rad` towards `target_rad`, by `most_rad` at the most.
double approach(double angle_rad, double target_rad, double most_rad) {
  return angle_rad + std::clamp(target_rad - angle_rad, -most_rad, most_rad);
}

}  // namespace

void KinematicBody::turn_devices(hal::TimeNs now) {
  if (!devices_at_) devices_at_ = now;
  while (*devices_at_ < now) {
    const hal::TimeNs until = std::min(now, *devices_at_ + kStepNs);
    turn_devices(until, hal::to_seconds(until - *devices_at_));
    devices_at_ = until;
  }
}

void KinematicBody::turn_devices(hal::TimeNs until, double dt_s) {
  if (command().turret == TurretMode::Speed) turret_rad_ = hal::wrapped(turret_rad_ + command().turret_rad_s * dt_s);
  if (command().turret == TurretMode::Position) {
    turret_rad_ = turned_towards(turret_rad_, command().turret_rad, robot_part<hal::TurretPart>().turn_rad_s * dt_s);
  }
  if (command().scanner == ScannerMode::Speed)
    scanner_rad_ = hal::wrapped(scanner_rad_ + command().scanner_rad_s * dt_s);
  if (command().scanner == ScannerMode::Position) {
    scanner_rad_ =
        turned_towards(scanner_rad_, command().scanner_rad, robot_part<hal::ScannerPart>().turn_rad_s * dt_s);
  }
  if (trying_grip_ && until >= grip_tried_at_) {
    trying_grip_ = false;
    gave_up_ = command().gripper_rad != 0.0;
  }
  gripper_rad_ = approach(gripper_rad_, gave_up_ ? 0.0 : command().gripper_rad, kClaws_rad_s * dt_s);
}

BodySenses KinematicBody::sense(hal::TimeNs now) {
  turn_devices(now);
  return WheeledBodyOf::sense(now);
}

void KinematicBody::look(BodySenses& senses) const {
  senses.turn_rad_s = turn_rad_s();
  senses.scanner_rad = scanner_rad_;
  senses.turret_rad = turret_rad_;
  senses.gripper_rad = gripper_rad_;
  senses.gripper_busy = trying_grip_;
  const bool scans = command().scanner != ScannerMode::Off;
  for (std::size_t i = 0; i < senses.scan_m.size(); ++i) {
    const double direction_rad =
        pose().heading_rad + scanner_rad_ + robot_part<hal::ScannerPart>().heads[i].bearing_rad;
    senses.scan_m[i] =
        scans ? std::min(senses.scan_m[i], free_m(0.0, 0.0, direction_rad)) : std::numeric_limits<double>::infinity();
  }
  see_walls(senses.distance_m);
}

void KinematicBody::actuate(hal::TimeNs now, const BodyCommand& command) {
  turn_devices(now);
  if (command.gripper_rad != this->command().gripper_rad) {
    trying_grip_ = true;
    gave_up_ = false;
    grip_tried_at_ = now + kTryNs;
  }
  WheeledBodyOf::actuate(now, command);
}

}  // namespace tandem::bridges::footbot_emulator
