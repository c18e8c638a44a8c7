#include "mixed_reality/fence/fence.hpp"

namespace tandem::mixed_reality {
namespace {

/// Whether moving by `step` leads over the bound, or further beyond it.
bool leads_out(double at, double step, double min, double max) noexcept {
  return (step > 0.0 && at + step > max) || (step < 0.0 && at + step < min);
}

/// An interval without `margin` at either side; where nothing is left, its middle.
void narrow(double& min, double& max, double margin) noexcept {
  min += margin;
  max -= margin;
  if (min > max) min = max = 0.5 * (min + max);
}

}  // namespace

Fence Fence::for_body(double radius_m, double height_m) const noexcept {
  Fence inner = *this;
  narrow(inner.min_x_m, inner.max_x_m, radius_m);
  narrow(inner.min_y_m, inner.max_y_m, radius_m);
  inner.max_z_m = std::max(0.0, max_z_m - height_m);
  return inner;
}

bool keep_inside(const Fence& fence, const core::Pose& pose, double look_ahead_s, hal::WheelSpeeds& wheels) noexcept {
  const double forward_m_s = 0.5 * (wheels.left_m_s + wheels.right_m_s);
  const double step_m = forward_m_s * look_ahead_s;
  if (!leads_out(pose.x_m, step_m * pose.cos_h, fence.min_x_m, fence.max_x_m) &&
      !leads_out(pose.y_m, step_m * pose.sin_h, fence.min_y_m, fence.max_y_m)) {
    return false;
  }
  wheels.left_m_s -= forward_m_s;
  wheels.right_m_s -= forward_m_s;
  return true;
}

bool keep_inside(const Fence& fence, const core::Pose& pose, double look_ahead_s, hal::QuadrotorSpeed& speed) noexcept {
  auto& v = speed.velocity;
  const bool x = leads_out(pose.x_m, v[0] * look_ahead_s, fence.min_x_m, fence.max_x_m);
  const bool y = leads_out(pose.y_m, v[1] * look_ahead_s, fence.min_y_m, fence.max_y_m);
  if (x) v[0] = 0.0;
  if (y) v[1] = 0.0;
  bool z = false;
  if (pose.z_m > fence.max_z_m) {
    z = v[2] > -kSinkIntoFence_m_s;
    if (z) v[2] = -kSinkIntoFence_m_s;
  } else if (pose.z_m + v[2] * look_ahead_s > fence.max_z_m) {
    z = true;
    v[2] = 0.0;
  }
  return x || y || z;
}

bool keep_inside(const Fence& fence, const core::Pose& pose, hal::QuadrotorPosition& target) noexcept {
  if (target.hold) {
    if (pose.z_m <= fence.max_z_m) return false;
    const core::Pose inside = fence.clamped(pose);
    target.set(inside.x_m, inside.y_m, inside.z_m, pose.heading_rad());
    return true;
  }
  const std::array<double, 3> wanted = target.target;
  target.target[0] = std::clamp(wanted[0], fence.min_x_m, fence.max_x_m);
  target.target[1] = std::clamp(wanted[1], fence.min_y_m, fence.max_y_m);
  target.target[2] = std::min(wanted[2], fence.max_z_m);
  return target.target != wanted;
}

}  // namespace tandem::mixed_reality
