#include "mixed_reality/twin/smooth_pose.hpp"

#include <algorithm>
#include <cmath>

#include "hal/angle.hpp"

namespace tandem::mixed_reality {

const core::Pose& SmoothPose::set(const core::Pose& honest) noexcept {
  x_m_ = y_m_ = z_m_ = turn_rad_ = left_s_ = 0.0;
  shown_ = honest;
  return shown_;
}

const core::Pose& SmoothPose::follow(const core::Pose& honest, const core::Pose& expected, double tick_s) noexcept {
  const double dx_m = honest.x_m - expected.x_m;
  const double dy_m = honest.y_m - expected.y_m;
  const double dz_m = honest.z_m - expected.z_m;
  const double turn_rad = std::atan2(honest.sin_h * expected.cos_h - honest.cos_h * expected.sin_h,
                                     honest.cos_h * expected.cos_h + honest.sin_h * expected.sin_h);
  const bool small = dx_m * dx_m + dy_m * dy_m + dz_m * dz_m < kSmall_m * kSmall_m && std::fabs(turn_rad) < kSmall_rad;
  if (!small) {
    x_m_ -= dx_m;
    y_m_ -= dy_m;
    z_m_ -= dz_m;
    turn_rad_ = hal::turn_between(turn_rad, turn_rad_);
    left_s_ = kBlend_s;
  }
  if (left_s_ <= 0.0) return set(honest);
  const double rest = std::max(0.0, left_s_ - tick_s) / left_s_;
  left_s_ = std::max(0.0, left_s_ - tick_s);
  for (double* apart : {&x_m_, &y_m_, &z_m_, &turn_rad_}) *apart *= rest;
  const double c = std::cos(turn_rad_);
  const double s = std::sin(turn_rad_);
  shown_ = {honest.x_m + x_m_, honest.y_m + y_m_, honest.z_m + z_m_, honest.cos_h * c - honest.sin_h * s,
            honest.sin_h * c + honest.cos_h * s};
  return shown_;
}

}  // namespace tandem::mixed_reality
