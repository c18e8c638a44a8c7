#include "mixed_reality/fence/fence.hpp"

namespace tandem::mixed_reality {
namespace {

/// Whether moving by `step` leads over the bound, or further beyond it.
bool leads_out(double at, double step, double min, double max) noexcept {
  return (step > 0.0 && at + step > max) || (step < 0.0 && at + step < min);
}

}  // namespace

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
  return x || y;
}

bool keep_inside(const Fence& fence, hal::QuadrotorPosition& target) noexcept {
  const double x_m = std::clamp(target.target[0], fence.min_x_m, fence.max_x_m);
  const double y_m = std::clamp(target.target[1], fence.min_y_m, fence.max_y_m);
  const bool outside = !target.hold && (x_m != target.target[0] || y_m != target.target[1]);
  target.target[0] = x_m;
  target.target[1] = y_m;
  return outside;
}

}  // namespace tandem::mixed_reality
