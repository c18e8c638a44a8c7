#include "mixed_reality/tracking/slip_watch.hpp"

#include <gtest/gtest.h>

#include "hal/robot/footbot.hpp"

namespace tandem::mixed_reality {
namespace {

constexpr hal::TimeNs kTick = 100 * hal::kNsPerMs;

/// A robot whose wheels roll and whom a tracker watches.
class WatchedWheels : public testing::Test {
 protected:
  /// One tick in which the wheels roll by `wheels_m` and the robot moves by `robot_m`.
  SlipWatch::Found tick(double wheels_m, double robot_m) {
    tracked_.taken_ns += kTick;
    tracked_.pose.x_m += robot_m;
    encoders_.left_m += wheels_m;
    encoders_.right_m += wheels_m;
    encoders_.validity = hal::Validity::Fresh;
    return watch_.judge(tracked_);
  }
  int times_in(int ticks, double wheels_m, double robot_m) {
    int times = 0;
    for (int i = 0; i < ticks; ++i) {
      const SlipWatch::Found found = tick(wheels_m, robot_m);
      times += found != SlipWatch::Found::Nothing ? 1 : 0;
      moved_ += found == SlipWatch::Found::Moved ? 1 : 0;
    }
    return times;
  }
  int moved_ = 0;  // of those times, found to be moved by somebody
  hal::WheelEncoders encoders_;
  TrackedPose tracked_{core::Pose::at(0.0, 0.0, 0.0), 5 * hal::kNsPerSecond, true};
  SlipWatch watch_{encoders_, hal::footbot::kind().drive()->wheel_base_m};
};

TEST_F(WatchedWheels, ThatMoveTheRobotAreWell) {
  EXPECT_EQ(times_in(100, 0.02, 0.02), 0);
  EXPECT_EQ(times_in(100, 0.02, 0.018), 0);  // a worn tyre
}

TEST_F(WatchedWheels, ThatSlipAtAWallAreNoticedWithinTwoSpans) {
  (void)times_in(30, 0.02, 0.02);
  EXPECT_GE(times_in(20, 0.02, 0.0), 1);
  EXPECT_EQ(moved_, 0) << "its wheels could have brought it there";
}

TEST_F(WatchedWheels, ARobotThatIsCarriedIsNoticedToo) {
  (void)times_in(30, 0.0, 0.0);
  EXPECT_GE(times_in(20, 0.0, 0.02), 1);
  EXPECT_GE(moved_, 1) << "not by its wheels";
}

TEST_F(WatchedWheels, WhatWasRolledInAnOutageIsNotHeldAgainstThem) {
  (void)times_in(15, 0.02, 0.02);
  encoders_.validity = hal::Validity::Stale;
  for (int i = 0; i < 30; ++i) {
    tracked_.taken_ns += kTick;
    EXPECT_EQ(watch_.judge(tracked_), SlipWatch::Found::Nothing);
  }
  tracked_.pose.x_m += 0.9;
  encoders_.left_m += 0.3;  // and encoders that were misread
  encoders_.right_m += 0.3;
  EXPECT_EQ(times_in(30, 0.02, 0.02), 0);
}

}  // namespace
}  // namespace tandem::mixed_reality
