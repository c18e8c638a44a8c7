#include "mixed_reality/twin/smooth_pose.hpp"

#include <gtest/gtest.h>
#include <numbers>

namespace tandem::mixed_reality {
namespace {

constexpr double kTick_s = 0.1;

core::Pose at(double x_m, double heading_rad = 0.0) {
  return core::Pose::at(x_m, 0.0, heading_rad);
}

TEST(SmoothPose, FollowsWhatWasExpectedAndSmallCorrectionsAtOnce) {
  SmoothPose smooth(at(0.0));
  EXPECT_EQ(smooth.follow(at(0.1), at(0.1), kTick_s).x_m, 0.1);
  EXPECT_EQ(smooth.follow(at(0.204), at(0.2), kTick_s).x_m, 0.204);
  EXPECT_FALSE(smooth.blending());
}

TEST(SmoothPose, SpreadsACorrectionOverItsTimeWhileTheRobotGoesOn) {
  SmoothPose smooth(at(0.0));
  EXPECT_NEAR(smooth.follow(at(0.3), at(0.0), kTick_s).x_m, 0.1, 1e-12);
  EXPECT_TRUE(smooth.blending());
  EXPECT_NEAR(smooth.follow(at(0.31), at(0.31), kTick_s).x_m, 0.21, 1e-12);
  EXPECT_NEAR(smooth.follow(at(0.32), at(0.32), kTick_s).x_m, 0.32, 1e-12);
  EXPECT_FALSE(smooth.blending());
}

TEST(SmoothPose, TurnsTheShorterWayRound) {
  using std::numbers::pi;
  SmoothPose smooth(at(0.0, pi - 0.1));
  const double heading_rad = smooth.follow(at(0.0, -pi + 0.2), at(0.0, pi - 0.1), kTick_s).heading_rad();
  EXPECT_NEAR(heading_rad, pi, 1e-9);  // a third of 0.3
}

TEST(SmoothPose, ACorrectionOnTheWayBeginsAnewWithoutAJump) {
  SmoothPose smooth(at(0.0));
  const double first = smooth.follow(at(0.3), at(0.0), kTick_s).x_m;
  const double second = smooth.follow(at(-0.3), at(0.3), kTick_s).x_m;
  EXPECT_LT(second, first);
  EXPECT_GT(second, first - 0.15);
}

}  // namespace
}  // namespace tandem::mixed_reality
