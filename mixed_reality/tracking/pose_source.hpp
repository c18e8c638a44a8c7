// Interface of a tracker: the pose of a real robot.
#pragma once
#include <cstdint>

#include "core/space/pose.hpp"
#include "hal/time.hpp"
#include "mixed_reality/time/moment.hpp"

namespace tandem::mixed_reality {

/// A pose of a real robot in W, and when it had it. How old a pose may be to act on is for its user to say.
struct TrackedPose {
  core::Pose pose;
  hal::TimeNs taken_ns = 0;  ///< CLOCK_MONOTONIC
  bool known = false;        ///< false: there never was one; `pose` is where the robot was said to start
};

/// A source of poses of one robot: odometry, a camera, a motion-capture system.
class PoseSource {
 public:
  virtual ~PoseSource() = default;

  /// The newest pose with a stamp of at most `now`. Called once a tick, after the robot's readings
  /// were latched; neither blocks nor allocates.
  virtual TrackedPose latch(const Moment& now) noexcept = 0;
  /// How many measurements it did not believe.
  virtual std::uint64_t rejected() const noexcept = 0;
  /// How often it believed in the end that the robot is farther from where it was than it can have moved.
  virtual std::uint64_t jumps() const noexcept { return 0; }
  /// Whether it knows of nothing but the wheels: what they slip it cannot tell.
  virtual bool by_wheels() const noexcept { return false; }
};

}  // namespace tandem::mixed_reality
