// Where a robot is by its own word: a flying robot's positioning system.
#pragma once
#include "hal/device/flight.hpp"
#include "mixed_reality/tracking/pose_source.hpp"

namespace tandem::mixed_reality {

/// Takes over what the robot says. The heading is that of the body's x axis, seen from above.
class Positioned final : public PoseSource {
 public:
  /// `places` must outlive this; its stamps are on the run's clock.
  Positioned(const core::Pose& start, const hal::Positioning& places);

  /// As old as the reading.
  TrackedPose latch(const Moment& now) noexcept override;
  /// Places that are nowhere: not finite.
  std::uint64_t rejected() const noexcept override { return rejected_; }

 private:
  const hal::Positioning& places_;
  TrackedPose tracked_;
  std::uint64_t rejected_ = 0;
};

}  // namespace tandem::mixed_reality
