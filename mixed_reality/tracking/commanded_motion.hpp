// The place of a robot on wheels between its poses and now, by its commands and their delay.
#pragma once
#include <cmath>
#include <utility>

#include "core/space/pose.hpp"
#include "hal/device/wheels.hpp"
#include "mixed_reality/delay/delay_finder.hpp"
#include "mixed_reality/tracking/odometry.hpp"

namespace tandem::mixed_reality {

/// All times are CLOCK_MONOTONIC. Allocates nothing.
class CommandedMotion {
 public:
  explicit CommandedMotion(double wheel_base_m) noexcept : wheel_base_m_(wheel_base_m) {}

  /// From now on this is its command; not to be called while it cannot hear.
  void told(hal::TimeNs now_ns, const hal::WheelSpeeds& wheels) noexcept {
    commands_.note({now_ns, wheels.left_m_s, wheels.right_m_s});
  }
  /// What its encoders said at `at_ns`; stamps that are not newer are left out.
  void counted(hal::TimeNs at_ns, double left_m, double right_m) noexcept {
    if (counting_ && at_ns <= counted_ns_) return;
    const double left = left_m - left_m_, right = right_m - right_m_;
    if (counting_ && std::fabs(left) + std::fabs(right) < kMost_m)
      finder_.note(commands_, counted_ns_, at_ns, left, right);
    counting_ = true;
    counted_ns_ = at_ns;
    left_m_ = left_m;
    right_m_ = right_m;
  }
  /// What it does is not known for a while.
  void forget() noexcept { counting_ = false; }

  /// From a command until its encoders' stamps show it.
  DelayEstimate to_counters() const noexcept { return finder_.estimate(); }
  /// From a command until the floor shows it; `lag_s`: by which the floor is later than the encoders. 0: not known.
  double to_way_s(double lag_s) const noexcept {
    const DelayEstimate found = finder_.estimate();
    return found.told ? std::max(0.0, found.value_s + lag_s) : 0.0;
  }
  /// Stretches of one command in [from, until) of a robot that obeys so late: `use(left_m_s, right_m_s, seconds)`.
  template <class Use>
  void each(hal::TimeNs from_ns, hal::TimeNs until_ns, double late_s, Use&& use) const {
    const auto late_ns = static_cast<hal::TimeNs>(std::llround(late_s * 1e9));
    commands_.each(from_ns - late_ns, until_ns - late_ns, std::forward<Use>(use));
  }
  /// `pose`, which it had at `from_ns`, as it drives on until `until_ns`, obeying `late_s` after it was told.
  core::Pose carried_on(const core::Pose& pose, hal::TimeNs from_ns, hal::TimeNs until_ns,
                        double late_s) const noexcept {
    core::Pose on = pose;
    each(from_ns, until_ns, late_s, [&](double left_m_s, double right_m_s, double s) {
      on = rolled(on, left_m_s * s, right_m_s * s, wheel_base_m_);
    });
    return on;
  }

 private:
  static constexpr double kMost_m = 0.5;  // between two readings: more is a reset
  double wheel_base_m_;
  CommandHistory commands_;
  DelayFinder finder_;
  bool counting_ = false;
  hal::TimeNs counted_ns_ = 0;
  double left_m_ = 0.0, right_m_ = 0.0;
};

}  // namespace tandem::mixed_reality
