// Measures how long after a command a robot on wheels moves as it says.
#pragma once
#include <array>
#include <cstdint>
#include <string_view>

#include "hal/device/wheels.hpp"
#include "mixed_reality/tracking/motion_trail.hpp"
#include "mixed_reality/tracking/pose_measurement.hpp"

namespace tandem::mixed_reality {

/// Compares the motion that the commands of the last kSpan_s make with that of the encoders, and with what trackers
/// see: the delay at which both fit best. Only changes of speed tell it. A delay is believed where it fits clearly
/// better than all that were counted on; what slips, is held or does not obey fits with none.
///
/// Trackers that are later than they say cannot be told from a robot that obeys later: for whom keeps others away from
/// it both are the same.
class DelayWatch {
 public:
  static constexpr double kSpan_s = 2.0;
  static constexpr hal::TimeNs kLongest_ns = 1000 * hal::kNsPerMs;

  /// `settle_s`: from full speed to full speed back (MotionLimits); a quarter of it looks like a delay, and is none.
  DelayWatch(double wheel_base_m, double settle_s) : wheel_base_m_(wheel_base_m), settle_s_(settle_s) {}

  /// From now on this is its command. Calls by time; all times are monotonic.
  void told(hal::TimeNs now_ns, const hal::WheelSpeeds& wheels) noexcept;
  /// The encoders as they were read last; stamps that are not newer are left out.
  void rolled(hal::TimeNs at_ns, double left_m, double right_m) noexcept;
  void seen(const PoseMeasurement& pose) noexcept;
  /// What it does is not known for a while: its link does not answer.
  void forget() noexcept;

  /// Once a tick. `counted_s`: the delay that is counted on. @returns whether a longer one was found.
  bool judge(hal::TimeNs now_ns, double counted_s) noexcept;
  /// The longest of the last few that were believed; 0: none was.
  double delay_s() const noexcept;
  /// "its wheels", "trackers": the source of the last one.
  std::string_view told_by() const noexcept { return told_by_; }

 private:
  double beyond_s(const MotionTrail& motion, double sd_m, const MotionSpan& span, double counted_s) const noexcept;

  double wheel_base_m_, settle_s_;
  ReckonedTrail commands_, wheels_;
  MotionTrail seen_;
  double sd_m_ = 0.0;  // of what was seen last
  hal::WheelSpeeds now_told_;
  hal::TimeNs told_ns_ = 0, changed_ns_ = 0, judged_ns_ = 0;
  bool ever_ = false, telling_ = false, rolling_ = false;
  double left_m_ = 0.0, right_m_ = 0.0;
  double left_to_m_ = 0.0, right_to_m_ = 0.0;  // by commands, since the trail's last point
  std::array<double, 4> believed_s_{};
  std::size_t count_ = 0;
  std::string_view told_by_;
};

}  // namespace tandem::mixed_reality
