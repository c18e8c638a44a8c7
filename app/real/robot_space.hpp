// A real robot as a space: displays, drawings, lists and records work on it as on a world's.
#pragma once
#include <cstdint>
#include <memory>

#include "app/real/robot_sinks.hpp"
#include "core/space/shown.hpp"
#include "core/space/space.hpp"
#include "hal/controller.hpp"
#include "mixed_reality/tracking/pose_source.hpp"

namespace tandem::app {

/// Ports and published state are read where they lie; nothing is copied. The robot stands where its file says, and goes
/// from there as its wheels say, or is where it says itself to be. Used by the thread that drives it.
class RobotSpace {
 public:
  /// Has the robot tell where it is, or what its wheels rolled, where it can; so before the bridge starts.
  explicit RobotSpace(const ShownRobot& robot);
  RobotSpace(const RobotSpace&) = delete;
  RobotSpace& operator=(const RobotSpace&) = delete;

  /// After every tick, with the number of the one that was done. `now` is CLOCK_MONOTONIC.
  void take(hal::Tick tick, hal::TimeNs now, bool drives);
  const core::Space& space() const noexcept { return space_; }

 private:
  std::int64_t ticks_per_second_;
  core::Space space_;
  hal::ControllerType controller_;  // its name alone
  std::unique_ptr<mixed_reality::PoseSource> poses_;
  core::Pose start_;
  core::SeenPose was_;
};

}  // namespace tandem::app
