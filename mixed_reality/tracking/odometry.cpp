#include "mixed_reality/tracking/odometry.hpp"

#include <cmath>

namespace tandem::mixed_reality {
namespace {

constexpr double kSpeedMargin = 1.25;   // firmwares clamp above the kind's speed, and stamps jitter
constexpr double kStepMargin_m = 0.01;  // what jitter of the stamps may add in a short step

}  // namespace

core::Pose rolled(const core::Pose& pose, double left_m, double right_m, double wheel_base_m) noexcept {
  const double way_m = 0.5 * (left_m + right_m);
  const double turn_rad = (right_m - left_m) / wheel_base_m;
  const double half_rad = 0.5 * turn_rad;
  // Chord of the arc: 2 r sin(turn / 2), towards the heading half-way. The series is exact to 1e-16 below 1e-4.
  const double sinc = std::fabs(half_rad) < 1e-4 ? 1.0 - half_rad * half_rad / 6.0 : std::sin(half_rad) / half_rad;
  const double chord_m = way_m * sinc;
  const double cos_half = std::cos(half_rad);
  const double sin_half = std::sin(half_rad);
  core::Pose next = pose;
  next.x_m += chord_m * (pose.cos_h * cos_half - pose.sin_h * sin_half);
  next.y_m += chord_m * (pose.sin_h * cos_half + pose.cos_h * sin_half);
  const double cos_turn = std::cos(turn_rad);
  const double sin_turn = std::sin(turn_rad);
  next.cos_h = pose.cos_h * cos_turn - pose.sin_h * sin_turn;
  next.sin_h = pose.sin_h * cos_turn + pose.cos_h * sin_turn;
  const double length = std::hypot(next.cos_h, next.sin_h);
  next.cos_h /= length;
  next.sin_h /= length;
  return next;
}

Odometry::Odometry(const core::Pose& start, const hal::DifferentialDrive& drive, const hal::WheelEncoders& encoders)
    : encoders_(encoders), wheel_base_m_(drive.wheel_base_m), max_speed_m_s_(drive.max_speed_m_s) {
  tracked_.pose = start;
}

TrackedPose Odometry::latch(const Moment& now) noexcept {
  if (encoders_.validity == hal::Validity::Absent) return tracked_;
  const hal::TimeNs taken_ns = now.to_monotonic(encoders_.taken_ns);
  if (taken_ns > now.monotonic_ns) {
    if (encoders_.taken_ns != future_ns_) ++rejected_;
    future_ns_ = encoders_.taken_ns;
    return tracked_;
  }
  if (tracked_.known && taken_ns <= tracked_.taken_ns) return tracked_;
  const double left_m = encoders_.left_m - left_m_;
  const double right_m = encoders_.right_m - right_m_;
  if (tracked_.known) {
    if (believable(left_m, right_m, taken_ns - tracked_.taken_ns)) {
      tracked_.pose = rolled(tracked_.pose, left_m, right_m, wheel_base_m_);
    } else {
      ++rejected_;
    }
  }
  if (!std::isfinite(left_m) || !std::isfinite(right_m)) return tracked_;
  left_m_ = encoders_.left_m;
  right_m_ = encoders_.right_m;
  tracked_.taken_ns = taken_ns;
  tracked_.known = true;
  return tracked_;
}

bool Odometry::believable(double left_m, double right_m, hal::TimeNs since_ns) const noexcept {
  const double limit_m = kSpeedMargin * max_speed_m_s_ * hal::to_seconds(since_ns) + kStepMargin_m;
  return std::fabs(left_m) <= limit_m && std::fabs(right_m) <= limit_m;  // false for NaN
}

}  // namespace tandem::mixed_reality
