#include "mixed_reality/safety/fence.hpp"

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

}  // namespace tandem::mixed_reality
