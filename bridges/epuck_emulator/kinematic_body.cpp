#include "bridges/epuck_emulator/kinematic_body.hpp"

#include <algorithm>
#include <cmath>
#include <limits>

#include "bridges/emulation/true_pose.hpp"
#include "hal/angle.hpp"
#include "hal/device/ring_sensors.hpp"

namespace tandem::bridges::epuck_emulator {
namespace {

constexpr hal::TimeNs kStepNs = 10 * hal::kNsPerMs;  // between two looks at the walls

/// Along one axis: how far until the wall at +-half_m, moving by `per_m` a metre of ray.
double to_wall_m(double at_m, double per_m, double half_m) {
  if (per_m > 0.0) return std::max(0.0, (half_m - at_m) / per_m);
  if (per_m < 0.0) return std::max(0.0, (-half_m - at_m) / per_m);
  return std::numeric_limits<double>::infinity();
}

}  // namespace

KinematicBody::KinematicBody(const Pose& start, const std::optional<Arena>& arena, const WheelErrors& errors)
    : pose_(start), arena_(arena), wheels_(errors) {}

void KinematicBody::advance(hal::TimeNs now) {
  if (!at_) at_ = now;
  const bool by_steps = arena_ || wheels_.errors().any();
  if (wheels_.still()) at_ = std::max(*at_, now);
  while (*at_ < now) {
    const hal::TimeNs until = by_steps ? std::min(now, *at_ + kStepNs) : now;
    roll(until);
    at_ = until;
  }
}

void KinematicBody::roll(hal::TimeNs until) {
  const ImperfectWheels::Ways ways = wheels_.roll(*at_, until, pose_.x_m, pose_.y_m);
  pose_ = rolled(pose_, ways.left_m, ways.right_m,
                 wheels_.errors().base * robot_part<hal::DifferentialDrive>().wheel_base_m);
  if (!arena_) return;
  const double free_x_m = std::max(0.0, 0.5 * arena_->length_x_m - robot_part<hal::Body>().radius_m);
  const double free_y_m = std::max(0.0, 0.5 * arena_->length_y_m - robot_part<hal::Body>().radius_m);
  pose_.x_m = std::clamp(pose_.x_m, -free_x_m, free_x_m);
  pose_.y_m = std::clamp(pose_.y_m, -free_y_m, free_y_m);
}

double KinematicBody::distance_to_wall_m(double x_m, double y_m, double direction_rad) const {
  return std::min(to_wall_m(x_m, std::cos(direction_rad), 0.5 * arena_->length_x_m),
                  to_wall_m(y_m, std::sin(direction_rad), 0.5 * arena_->length_y_m));
}

BodySenses KinematicBody::sense(hal::TimeNs now) {
  advance(now);
  BodySenses senses = surroundings;
  const ImperfectWheels::Ways rolls = wheels_.speeds_m_s(now);  // a second's
  senses.turn_rad_s[2] =
      (rolls.right_m - rolls.left_m) / (wheels_.errors().base * robot_part<hal::DifferentialDrive>().wheel_base_m);
  if (!arena_) return senses;
  const double c = std::cos(pose_.heading_rad);
  const double s = std::sin(pose_.heading_rad);
  for (std::size_t i = 0; i < senses.distance_m.size(); ++i) {
    const hal::Mount& m = robot_part<hal::ProximityPart>().mounts[i];
    const double free_m = distance_to_wall_m(pose_.x_m + c * m.x_m - s * m.y_m, pose_.y_m + s * m.x_m + c * m.y_m,
                                             pose_.heading_rad + m.bearing_rad);
    senses.distance_m[i] = std::min({senses.distance_m[i], free_m, robot_part<hal::ProximityPart>().range_m});
  }
  senses.ahead_m =
      std::min(senses.ahead_m, distance_to_wall_m(pose_.x_m + c * robot_part<hal::Body>().radius_m,
                                                  pose_.y_m + s * robot_part<hal::Body>().radius_m, pose_.heading_rad));
  return senses;
}

void KinematicBody::actuate(hal::TimeNs now, const BodyCommand& command) {
  advance(now);
  command_ = command;
  wheels_.tell(now, command.left_m_s, command.right_m_s);
}

}  // namespace tandem::bridges::epuck_emulator
