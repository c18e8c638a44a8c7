#include "bridges/emulation/wheeled_body.hpp"

#include <algorithm>
#include <cmath>
#include <limits>

#include "bridges/emulation/true_pose.hpp"
#include "hal/angle.hpp"
#include "hal/device/ring_sensors.hpp"

namespace tandem::bridges {
namespace {

constexpr hal::TimeNs kStepNs = 10 * hal::kNsPerMs;  // between two looks at walls, noise, floor and late wheels

/// Along one axis: how far until the wall at +-half_m, moving by `per_m` a metre of ray.
double to_wall_m(double at_m, double per_m, double half_m) {
  if (per_m > 0.0) return std::max(0.0, (half_m - at_m) / per_m);
  if (per_m < 0.0) return std::max(0.0, (-half_m - at_m) / per_m);
  return std::numeric_limits<double>::infinity();
}

}  // namespace

double Arena::distance_m(double x_m, double y_m, double direction_rad) const {
  return std::min(to_wall_m(x_m, std::cos(direction_rad), 0.5 * length_x_m),
                  to_wall_m(y_m, std::sin(direction_rad), 0.5 * length_y_m));
}

double turned_towards(double angle_rad, double target_rad, double most_rad) noexcept {
  return hal::wrapped(angle_rad + std::clamp(hal::wrapped(target_rad - angle_rad), -most_rad, most_rad));
}

void WheeledBody::advance(hal::TimeNs now) {
  if (!at_) at_ = now;
  const bool by_steps = arena_ || wheels_.errors().any();
  if (wheels_.still()) at_ = std::max(*at_, now);
  while (*at_ < now) {
    const hal::TimeNs until = by_steps ? std::min(now, *at_ + kStepNs) : now;
    roll(until);
    at_ = until;
  }
  pose_.taken_ns = *at_;
}

void WheeledBody::roll(hal::TimeNs until) {
  const ImperfectWheels::Ways ways = wheels_.roll(*at_, until, pose_.x_m, pose_.y_m);
  if (held_) return;
  pose_ = rolled(pose_, ways.left_m, ways.right_m, wheels_.errors().base * kind_.drive()->wheel_base_m);
  if (!arena_) return;
  const double free_x_m = std::max(0.0, 0.5 * arena_->length_x_m - kind_.body.radius_m);
  const double free_y_m = std::max(0.0, 0.5 * arena_->length_y_m - kind_.body.radius_m);
  pose_.x_m = std::clamp(pose_.x_m, -free_x_m, free_x_m);
  pose_.y_m = std::clamp(pose_.y_m, -free_y_m, free_y_m);
}

void WheeledBody::tell(hal::TimeNs now, double left_m_s, double right_m_s) {
  advance(now);
  wheels_.tell(now, left_m_s, right_m_s);
}

void WheeledBody::carry(hal::TimeNs now, double x_m, double y_m, double turn_rad) {
  advance(now);
  pose_ = {pose_.x_m + x_m, pose_.y_m + y_m, hal::wrapped(pose_.heading_rad + turn_rad), pose_.taken_ns};
}

void WheeledBody::hold(hal::TimeNs now, bool held) {
  advance(now);
  held_ = held;
}

double WheeledBody::turn_rad_s() const noexcept {
  const ImperfectWheels::Ways rolls = wheels_.speeds_m_s(at_.value_or(0));  // a second's
  if (held_) return 0.0;
  return (rolls.right_m - rolls.left_m) / (wheels_.errors().base * kind_.drive()->wheel_base_m);
}

double WheeledBody::free_m(double x_B_m, double y_B_m, double direction_rad) const {
  if (!arena_) return std::numeric_limits<double>::infinity();
  const double c = std::cos(pose_.heading_rad), s = std::sin(pose_.heading_rad);
  return arena_->distance_m(pose_.x_m + c * x_B_m - s * y_B_m, pose_.y_m + s * x_B_m + c * y_B_m, direction_rad);
}

void WheeledBody::see_walls(std::span<double> distance_m) const {
  if (!arena_) return;
  const auto& ring = *kind_.part<hal::ProximityPart>();
  for (std::size_t i = 0; i < distance_m.size(); ++i) {
    const hal::Mount& m = ring.mounts[i];
    const double free = free_m(m.x_m, m.y_m, pose_.heading_rad + m.bearing_rad);
    distance_m[i] = std::min({distance_m[i], free, ring.range_m});
  }
}

}  // namespace tandem::bridges
