// Pose of a flying robot by its own positioning system.
#pragma once
#include "hal/device/flight.hpp"
#include "hal/robot_kind.hpp"
#include "mixed_reality/tracking/pose_source.hpp"

namespace tandem::mixed_reality {

/// Takes over what the robot says. The heading is that of the body's x axis, seen from above.
///
/// Not believed, and counted, are places that are nowhere (not finite), of the future, or farther from the last one
/// than the robot can have moved. When kInsists such places in a row agree with one another they are believed after
/// all: that is a jump.
class Positioned final : public PoseSource {
 public:
  static constexpr int kInsists = 5;

  /// `places` must outlive this; its stamps are on the run's clock. `kind`: the largest speed.
  Positioned(const core::Pose& start, const hal::Positioning& places, const hal::RobotKind& kind);

  /// As old as the reading.
  std::string_view name() const noexcept override { return "positioning"; }
  TrackedPose latch(const Moment& now) noexcept override;
  std::uint64_t rejected() const noexcept override { return rejected_; }
  std::uint64_t jumps() const noexcept override { return jumps_; }

 private:
  bool reachable(const TrackedPose& from, const core::Pose& to, hal::TimeNs at_ns) const noexcept;

  const hal::Positioning& places_;
  double max_speed_m_s_;
  TrackedPose tracked_;
  TrackedPose other_;  // the last place that was not believed, and how many agreed
  int insisted_ = 0;
  hal::TimeNs seen_ns_ = 0;     // when the last reading that was looked at was taken
  hal::TimeNs future_ns_ = -1;  // stamp of the last one that no place could be made of
  std::uint64_t rejected_ = 0, jumps_ = 0;
};

}  // namespace tandem::mixed_reality
