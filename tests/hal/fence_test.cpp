
#include <cmath>
#include <gtest/gtest.h>
#include <numbers>

#include "hal/device/flight.hpp"
#include "hal/device/wheels.hpp"

namespace tandem::hal {
namespace {

using std::numbers::pi;
constexpr Fence kFence{-1.0, -0.5, 1.0, 0.5, 2.0};

Pose at(double x_m, double y_m, double heading_rad) {
  return {x_m, y_m, 0.0, std::cos(heading_rad), std::sin(heading_rad)};
}

WheelSpeeds kept(const Pose& pose, double left, double right) {
  WheelSpeeds wheels;
  wheels.set(left, right);
  wheels.keep_inside(kFence, pose, 0.5);
  return wheels;
}

TEST(ArenaFence, LeavesARobotAloneThatIsFarFromTheEdge) {
  EXPECT_EQ(kept(at(0.0, 0.0, 0.0), 0.1, 0.05).left_m_s, 0.1);
  EXPECT_EQ(kept(at(0.94, 0.0, 0.0), 0.1, 0.1).left_m_s, 0.1);
}

TEST(ArenaFence, ARobotThatWouldLeaveMayStillTurn) {
  for (const double heading : {0.0, pi / 2.0, pi, -pi / 2.0}) {
    const Pose edge = at(0.99 * std::cos(heading), 0.49 * std::sin(heading), heading);
    const WheelSpeeds wheels = kept(edge, 0.1, 0.06);
    EXPECT_NEAR(wheels.left_m_s, 0.02, 1e-12) << heading;
    EXPECT_NEAR(wheels.right_m_s, -0.02, 1e-12) << heading;
  }
}

TEST(ArenaFence, BackwardsIsLookedAtToo) {
  EXPECT_EQ(kept(at(0.99, 0.0, pi), -0.1, -0.1).left_m_s, 0.0);
}

TEST(ArenaFence, ARobotOutsideMayComeBackButGoNoFurther) {
  EXPECT_EQ(kept(at(1.3, 0.0, pi), 0.1, 0.1).left_m_s, 0.1);
  EXPECT_EQ(kept(at(1.3, 0.0, 0.0), 0.1, 0.1).left_m_s, 0.0);
}

TEST(ArenaFence, ClampsPosesAndKnowsWhatIsInside) {
  EXPECT_TRUE(kFence.contains(at(1.0, -0.5, 0.0)));
  EXPECT_FALSE(kFence.contains(at(1.01, 0.0, 0.0)));
  EXPECT_EQ(kFence.clamped(at(1.3, -7.0, 0.0)).x_m, 1.0);
  EXPECT_EQ(kFence.clamped(at(1.3, -7.0, 0.0)).y_m, -0.5);
}

TEST(ArenaFence, ARobotThatFliesKeepsThePartOfItsVelocityThatStaysInside) {
  QuadrotorSpeed speed;
  speed.set(0.5, 0.3, -0.2, 0.1);
  EXPECT_FALSE(speed.keep_inside(kFence, at(0.0, 0.0, 0.0), 0.5));
  EXPECT_TRUE(speed.keep_inside(kFence, at(0.9, 0.0, 0.0), 0.5));
  EXPECT_EQ(speed.velocity[0], 0.0);
  EXPECT_EQ(speed.velocity[1], 0.3);
  EXPECT_EQ(speed.velocity[2], -0.2);
  EXPECT_EQ(speed.yaw_rad_s, 0.1);
  speed.set(-0.5, 0.0, 0.0, 0.0);
  EXPECT_FALSE(speed.keep_inside(kFence, at(1.5, 0.0, 0.0), 0.5));  // it comes back
  EXPECT_EQ(speed.velocity[0], -0.5);
}

TEST(ArenaFence, APlaceOutsideBecomesTheNearestInside) {
  QuadrotorPosition position;
  position.set(5.0, -5.0, 3.0, 1.0);
  EXPECT_TRUE(position.keep_inside(kFence, at(0.0, 0.0, 0.0), 0.5));
  EXPECT_EQ(position.target[0], 1.0);
  EXPECT_EQ(position.target[1], -0.5);
  EXPECT_EQ(position.target[2], 2.0);
  EXPECT_FALSE(position.keep_inside(kFence, at(0.0, 0.0, 0.0), 0.5));
  position.set(5.0, 0.0, 0.0, 0.0);
  position.hover();
  EXPECT_FALSE(position.keep_inside(kFence, at(0.0, 0.0, 0.0), 0.5));  // it goes nowhere
}

Pose above(double z_m) {
  Pose pose = at(0.2, 0.1, 0.5);
  pose.z_m = z_m;
  return pose;
}

TEST(ArenaFence, NothingRisesThroughTheCeiling) {
  QuadrotorSpeed speed;
  speed.set(0.1, 0.0, 0.4, 0.0);
  EXPECT_FALSE(speed.keep_inside(kFence, above(1.7), 0.5));
  EXPECT_TRUE(speed.keep_inside(kFence, above(1.9), 0.5));
  EXPECT_EQ(speed.velocity[2], 0.0);
  EXPECT_EQ(speed.velocity[0], 0.1);
}

TEST(ArenaFence, ARobotAboveTheCeilingIsBroughtBackWhateverWasWanted) {
  QuadrotorSpeed hover;
  EXPECT_TRUE(hover.keep_inside(kFence, above(3.0), 0.5));
  EXPECT_EQ(hover.velocity[2], -QuadrotorSpeed::kSinkIntoFence_m_s);
  hover.set(0.0, 0.0, -0.5, 0.0);
  EXPECT_FALSE(hover.keep_inside(kFence, above(3.0), 0.5));
  EXPECT_EQ(hover.velocity[2], -0.5);
  QuadrotorPosition hold;
  EXPECT_TRUE(hold.keep_inside(kFence, above(3.0), 0.5));
  EXPECT_FALSE(hold.hold);
  EXPECT_EQ(hold.target[0], 0.2);
  EXPECT_EQ(hold.target[2], 2.0);
}

TEST(ArenaFence, WithoutACeilingNothingIsTooHigh) {
  constexpr Fence kOpen{-1.0, -0.5, 1.0, 0.5};
  QuadrotorSpeed speed;
  speed.set(0.0, 0.0, 0.4, 0.0);
  EXPECT_FALSE(speed.keep_inside(kOpen, above(100.0), 0.5));
}

TEST(ArenaFence, KnowsTheBody) {
  const Fence inner = kFence.for_body(0.2, 0.5);
  EXPECT_NEAR(inner.min_x_m, -0.8, 1e-12);
  EXPECT_NEAR(inner.max_y_m, 0.3, 1e-12);
  EXPECT_NEAR(inner.max_z_m, 1.5, 1e-12);
  const Fence narrow = kFence.for_body(0.7, 3.0);
  EXPECT_EQ(narrow.min_y_m, narrow.max_y_m);
  EXPECT_EQ(narrow.max_z_m, 0.0);
}

}  // namespace
}  // namespace tandem::hal
