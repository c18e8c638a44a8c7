// Where a real robot is: what every tracker answers.
#pragma once
#include "core/space/pose.hpp"
#include "hal/port.hpp"
#include "hal/time.hpp"
#include "mixed_reality/time/moment.hpp"

namespace tandem::mixed_reality {

/// A pose of a real robot in W, and when it had it.
struct TrackedPose {
  core::Pose pose;
  hal::TimeNs taken_ns = 0;                        ///< CLOCK_MONOTONIC
  hal::Validity validity = hal::Validity::Absent;  ///< Absent: never known. Stale: the source says it is out of date
};

/// A source of poses of one robot: odometry, a camera, a motion-capture system.
class PoseSource {
 public:
  virtual ~PoseSource() = default;

  /// The newest pose with a stamp of at most `now`. Called once a tick, after the robot's readings
  /// were latched; neither blocks nor allocates.
  virtual TrackedPose latch(const Moment& now) noexcept = 0;
};

}  // namespace tandem::mixed_reality
