// Poses without jumps: what the simulated world sees of a robot whose pose is corrected.
#pragma once
#include "core/space/pose.hpp"

namespace tandem::mixed_reality {

/// Follows the poses of a robot. Where one lies apart from what its motion led to expect (an outage is over, a tracker
/// corrects), the way there is spread evenly over kBlend_s. Small corrections are taken over at once.
class SmoothPose {
 public:
  static constexpr double kBlend_s = 0.3;
  static constexpr double kSmall_m = 0.005;
  static constexpr double kSmall_rad = 0.035;

  explicit SmoothPose(const core::Pose& start) : shown_(start) {}

  /// `honest`: where the robot is in this tick, as well as is known. `expected`: where it was to be by what was known
  /// in the tick before.
  const core::Pose& follow(const core::Pose& honest, const core::Pose& expected, double tick_s) noexcept;
  /// Takes over a pose as it is, at once.
  const core::Pose& set(const core::Pose& honest) noexcept;

  const core::Pose& shown() const noexcept { return shown_; }
  /// Whether the pose shown is still on its way.
  bool blending() const noexcept { return left_s_ > 0.0; }

 private:
  core::Pose shown_;
  double x_m_ = 0.0, y_m_ = 0.0, z_m_ = 0.0, turn_rad_ = 0.0;  // what is shown lies so far from the robot
  double left_s_ = 0.0;                                        // until that is 0
};

}  // namespace tandem::mixed_reality
