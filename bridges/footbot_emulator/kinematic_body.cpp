#include "bridges/footbot_emulator/kinematic_body.hpp"

#include <algorithm>
#include <cmath>
#include <limits>

#include "bridges/emulation/true_pose.hpp"
#include "hal/angle.hpp"
#include "hal/device/distance_scanner.hpp"
#include "hal/device/ring_sensors.hpp"
#include "hal/device/turret.hpp"

namespace tandem::bridges::footbot_emulator {
namespace {

using std::numbers::pi;

constexpr hal::TimeNs kStepNs = 10 * hal::kNsPerMs;  // between two looks at the walls
constexpr hal::TimeNs kTryNs = hal::kNsPerSecond;    // a grip is tried for up to so long
constexpr double kClaws_rad_s = pi;                  // wide open in half a second

/// Along one axis: how far until the wall at +-half_m, moving by `per_m` a metre of ray.
double to_wall_m(double at_m, double per_m, double half_m) {
  if (per_m > 0.0) return std::max(0.0, (half_m - at_m) / per_m);
  if (per_m < 0.0) return std::max(0.0, (-half_m - at_m) / per_m);
  return std::numeric_limits<double>::infinity();
}

/// From `angle_rad` towards `target_rad`, by `most_rad` at the most.
double approach(double angle_rad, double target_rad, double most_rad) {
  return angle_rad + std::clamp(target_rad - angle_rad, -most_rad, most_rad);
}

/// The same, on the shorter way around the circle.
double turn_to(double angle_rad, double target_rad, double most_rad) {
  return hal::wrapped(angle_rad + std::clamp(hal::wrapped(target_rad - angle_rad), -most_rad, most_rad));
}

}  // namespace

KinematicBody::KinematicBody(const Pose& start, const std::optional<Arena>& arena, const WheelErrors& errors)
    : pose_(start), arena_(arena), wheels_(errors) {}

void KinematicBody::advance(hal::TimeNs now) {
  if (!at_) at_ = now;
  while (*at_ < now) {
    const hal::TimeNs until = std::min(now, *at_ + kStepNs);
    const double dt_s = hal::to_seconds(until - *at_);
    roll(until);
    turn_devices(until, dt_s);
    at_ = until;
  }
}

void KinematicBody::roll(hal::TimeNs until) {
  const ImperfectWheels::Ways ways = wheels_.roll(*at_, until, pose_.x_m, pose_.y_m);
  if (held_) return;
  pose_ = rolled(pose_, ways.left_m, ways.right_m,
                 wheels_.errors().base * robot_part<hal::DifferentialDrive>().wheel_base_m);
  if (!arena_) return;
  const double free_x_m = std::max(0.0, 0.5 * arena_->length_x_m - robot_part<hal::Body>().radius_m);
  const double free_y_m = std::max(0.0, 0.5 * arena_->length_y_m - robot_part<hal::Body>().radius_m);
  pose_.x_m = std::clamp(pose_.x_m, -free_x_m, free_x_m);
  pose_.y_m = std::clamp(pose_.y_m, -free_y_m, free_y_m);
}

void KinematicBody::carry(hal::TimeNs now, double x_m, double y_m, double turn_rad) {
  advance(now);
  pose_ = {pose_.x_m + x_m, pose_.y_m + y_m, hal::wrapped(pose_.heading_rad + turn_rad)};
}

void KinematicBody::hold(hal::TimeNs now, bool held) {
  advance(now);
  held_ = held;
}

void KinematicBody::turn_devices(hal::TimeNs until, double dt_s) {
  if (command_.turret == TurretMode::Speed) turret_rad_ = hal::wrapped(turret_rad_ + command_.turret_rad_s * dt_s);
  if (command_.turret == TurretMode::Position) {
    turret_rad_ = turn_to(turret_rad_, command_.turret_rad, robot_part<hal::TurretPart>().turn_rad_s * dt_s);
  }
  if (command_.scanner == ScannerMode::Speed) scanner_rad_ = hal::wrapped(scanner_rad_ + command_.scanner_rad_s * dt_s);
  if (command_.scanner == ScannerMode::Position) {
    scanner_rad_ = turn_to(scanner_rad_, command_.scanner_rad, robot_part<hal::ScannerPart>().turn_rad_s * dt_s);
  }
  if (trying_grip_ && until >= grip_tried_at_) {
    trying_grip_ = false;
    gave_up_ = command_.gripper_rad != 0.0;
  }
  gripper_rad_ = approach(gripper_rad_, gave_up_ ? 0.0 : command_.gripper_rad, kClaws_rad_s * dt_s);
}

double KinematicBody::distance_to_wall_m(double x_m, double y_m, double direction_rad) const {
  return std::min(to_wall_m(x_m, std::cos(direction_rad), 0.5 * arena_->length_x_m),
                  to_wall_m(y_m, std::sin(direction_rad), 0.5 * arena_->length_y_m));
}

BodySenses KinematicBody::sense(hal::TimeNs now) {
  advance(now);
  BodySenses senses = surroundings;
  const ImperfectWheels::Ways rolls = wheels_.speeds_m_s(now);  // a second's
  senses.turn_rad_s = held_ ? 0.0
                            : (rolls.right_m - rolls.left_m) /
                                  (wheels_.errors().base * robot_part<hal::DifferentialDrive>().wheel_base_m);
  senses.scanner_rad = scanner_rad_;
  senses.turret_rad = turret_rad_;
  senses.gripper_rad = gripper_rad_;
  senses.gripper_busy = trying_grip_;
  const bool scans = command_.scanner != ScannerMode::Off;
  if (!scans) senses.scan_m.fill(std::numeric_limits<double>::infinity());
  if (!arena_) return senses;
  const double c = std::cos(pose_.heading_rad);
  const double s = std::sin(pose_.heading_rad);
  for (std::size_t i = 0; i < senses.distance_m.size(); ++i) {
    const hal::Mount& m = robot_part<hal::ProximityPart>().mounts[i];
    const double free_m = distance_to_wall_m(pose_.x_m + c * m.x_m - s * m.y_m, pose_.y_m + s * m.x_m + c * m.y_m,
                                             pose_.heading_rad + m.bearing_rad);
    senses.distance_m[i] = std::min({senses.distance_m[i], free_m, robot_part<hal::ProximityPart>().range_m});
  }
  for (std::size_t i = 0; i < senses.scan_m.size() && scans; ++i) {
    const double direction_rad = pose_.heading_rad + scanner_rad_ + robot_part<hal::ScannerPart>().heads[i].bearing_rad;
    senses.scan_m[i] = std::min(senses.scan_m[i], distance_to_wall_m(pose_.x_m, pose_.y_m, direction_rad));
  }
  return senses;
}

void KinematicBody::actuate(hal::TimeNs now, const BodyCommand& command) {
  advance(now);
  if (command.gripper_rad != command_.gripper_rad) {
    trying_grip_ = true;
    gave_up_ = false;
    grip_tried_at_ = now + kTryNs;
  }
  command_ = command;
  wheels_.tell(now, command.left_m_s, command.right_m_s);
}

}  // namespace tandem::bridges::footbot_emulator
