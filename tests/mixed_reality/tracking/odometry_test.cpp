#include "mixed_reality/tracking/odometry.hpp"

#include <cmath>
#include <gtest/gtest.h>
#include <limits>
#include <numbers>

#include "hal/robot/epuck.hpp"

namespace tandem::mixed_reality {
namespace {

using std::numbers::pi;

const double kBase_m = hal::epuck::kind().drive()->wheel_base_m;
constexpr hal::TimeNs kHour = 3'600 * hal::kNsPerSecond;
constexpr hal::TimeNs kTick = 100 * hal::kNsPerMs;

core::Pose at(double x_m, double y_m, double heading_rad) {
  return {x_m, y_m, 0.0, std::cos(heading_rad), std::sin(heading_rad)};
}

class WheelOdometry : public testing::Test {
 protected:
  TrackedPose roll_to(double left_m, double right_m) {
    encoders_.left_m = left_m;
    encoders_.right_m = right_m;
    encoders_.taken_ns = now_;
    encoders_.validity = hal::Validity::Fresh;
    const TrackedPose tracked = odometry_.latch(moment(now_));
    now_ += kTick;
    return tracked;
  }
  /// Both clocks run alike, an hour apart.
  static Moment moment(hal::TimeNs now_ns) { return {now_ns, now_ns + kHour}; }

  hal::WheelEncoders encoders_;
  Odometry odometry_{at(0.3, -0.2, 0.7), *hal::epuck::kind().drive(), encoders_};
  hal::TimeNs now_ = 0;
};

TEST(Rolled, StraightOnMovesAlongTheHeading) {
  const core::Pose p = rolled(at(1.0, 2.0, pi / 6.0), 0.5, 0.5, kBase_m);
  EXPECT_NEAR(p.x_m, 1.0 + 0.5 * std::cos(pi / 6.0), 1e-15);
  EXPECT_NEAR(p.y_m, 2.0 + 0.5 * std::sin(pi / 6.0), 1e-15);
  EXPECT_NEAR(p.heading_rad(), pi / 6.0, 1e-15);
}

TEST(Rolled, TurnsLeftWhenTheRightWheelIsFaster) {
  const double quarter = 0.5 * pi * kBase_m;
  const core::Pose p = rolled(at(0.0, 0.0, 0.0), 0.0, quarter, kBase_m);
  // Around the left wheel, which stands at (0, base / 2).
  EXPECT_NEAR(p.x_m, 0.5 * kBase_m, 1e-15);
  EXPECT_NEAR(p.y_m, 0.5 * kBase_m, 1e-15);
  EXPECT_NEAR(p.heading_rad(), pi / 2.0, 1e-12);
}

TEST(Rolled, OnTheSpotChangesTheHeadingAlone) {
  const core::Pose p = rolled(at(0.4, 0.5, 0.0), -0.25 * pi * kBase_m, 0.25 * pi * kBase_m, kBase_m);
  EXPECT_NEAR(p.x_m, 0.4, 1e-15);
  EXPECT_NEAR(p.y_m, 0.5, 1e-15);
  EXPECT_NEAR(p.heading_rad(), pi / 2.0, 1e-12);
}

TEST(Rolled, AWholeCircleComesBackHowFineItIsCutAlike) {
  const double radius_m = 0.2;
  for (const int pieces : {7, 100, 100'000}) {
    const double left_m = 2.0 * pi * (radius_m - 0.5 * kBase_m) / pieces;
    const double right_m = 2.0 * pi * (radius_m + 0.5 * kBase_m) / pieces;
    core::Pose p = at(0.1, 0.2, 0.3);
    for (int i = 0; i < pieces; ++i) p = rolled(p, left_m, right_m, kBase_m);
    EXPECT_NEAR(p.x_m, 0.1, 1e-10) << pieces;
    EXPECT_NEAR(p.y_m, 0.2, 1e-10) << pieces;
    EXPECT_NEAR(p.heading_rad(), 0.3, 1e-9) << pieces;
  }
}

TEST_F(WheelOdometry, StartsWhereItWasPutWhateverTheEncodersSayFirst) {
  EXPECT_FALSE(odometry_.latch(moment(0)).known);
  const TrackedPose first = roll_to(123.0, -45.0);
  EXPECT_TRUE(first.known);
  EXPECT_DOUBLE_EQ(first.pose.x_m, 0.3);
  EXPECT_DOUBLE_EQ(first.pose.y_m, -0.2);
  const TrackedPose second = roll_to(123.01, -44.99);
  EXPECT_NEAR(second.pose.x_m, 0.3 + 0.01 * std::cos(0.7), 1e-12);
  EXPECT_NEAR(second.pose.y_m, -0.2 + 0.01 * std::sin(0.7), 1e-12);
  EXPECT_EQ(second.taken_ns, kHour + kTick);
}

TEST_F(WheelOdometry, AgesWithTheEncodersAndCountsWhatWasRolledMeanwhile) {
  roll_to(0.0, 0.0);
  roll_to(0.01, 0.01);
  encoders_.validity = hal::Validity::Stale;
  now_ += 30 * kTick;
  const TrackedPose lost = odometry_.latch(moment(now_));
  EXPECT_EQ(lost.taken_ns, kHour + kTick);
  EXPECT_NEAR(lost.pose.x_m, 0.3 + 0.01 * std::cos(0.7), 1e-12);
  const TrackedPose back = roll_to(0.2, 0.2);
  EXPECT_NEAR(back.pose.x_m, 0.3 + 0.2 * std::cos(0.7), 1e-12);
  EXPECT_EQ(odometry_.rejected(), 0U);
}

TEST_F(WheelOdometry, BelievesWhatWasRolledWhileTheRunsClockStoodStill) {
  roll_to(0.0, 0.0);
  encoders_.left_m = encoders_.right_m = 0.2;  // one tick on the run's clock, but two seconds of a stalled hub
  encoders_.taken_ns = kTick;
  const TrackedPose after = odometry_.latch({kTick, kHour + 20 * kTick});
  EXPECT_NEAR(after.pose.x_m, 0.3 + 0.2 * std::cos(0.7), 1e-12);
  EXPECT_EQ(odometry_.rejected(), 0U);
}

TEST_F(WheelOdometry, DoesNotFollowEncodersThatJump) {
  roll_to(0.5, 0.5);
  const TrackedPose jumped = roll_to(0.0, 0.0);  // the robot was switched off and on
  EXPECT_DOUBLE_EQ(jumped.pose.x_m, 0.3);
  EXPECT_EQ(odometry_.rejected(), 1U);
  const TrackedPose on = roll_to(0.01, 0.01);
  EXPECT_NEAR(on.pose.x_m, 0.3 + 0.01 * std::cos(0.7), 1e-12);
  roll_to(std::numeric_limits<double>::quiet_NaN(), 0.01);
  EXPECT_EQ(odometry_.rejected(), 2U);
  EXPECT_NEAR(roll_to(0.02, 0.02).pose.x_m, 0.3 + 0.02 * std::cos(0.7), 1e-12);
}

TEST_F(WheelOdometry, UsesEachReadingOnceAndNoneFromTheFuture) {
  roll_to(0.0, 0.0);
  const TrackedPose once = roll_to(0.01, 0.01);
  const TrackedPose again = odometry_.latch(moment(now_));
  EXPECT_DOUBLE_EQ(again.pose.x_m, once.pose.x_m);
  encoders_.left_m = encoders_.right_m = 0.02;
  encoders_.taken_ns = now_ + kTick;
  EXPECT_DOUBLE_EQ(odometry_.latch(moment(now_)).pose.x_m, once.pose.x_m);
  EXPECT_GT(odometry_.latch(moment(now_ + kTick)).pose.x_m, once.pose.x_m);
}

TEST_F(WheelOdometry, AStampOfTheFutureIsCountedAndNotUsed) {
  (void)roll_to(0.0, 0.0);
  encoders_.left_m = encoders_.right_m = 0.01;
  encoders_.taken_ns = now_ + hal::kNsPerSecond;
  const TrackedPose tracked = odometry_.latch(moment(now_));
  (void)odometry_.latch(moment(now_));
  EXPECT_EQ(tracked.pose.x_m, 0.3);
  EXPECT_EQ(odometry_.rejected(), 1U);
  now_ += kTick;
  EXPECT_GT(roll_to(0.01, 0.01).pose.x_m, 0.3);
}

}  // namespace
}  // namespace tandem::mixed_reality
