#include "mixed_reality/safety/ramp.hpp"

#include <cmath>
#include <gtest/gtest.h>

namespace tandem::mixed_reality {
namespace {

TEST(RampLaw, HoldsWheelsAndFlightBackToOneSpeed) {
  const Ramp ramp = Ramp::after(0.4, 0.25);
  hal::WheelSpeeds wheels;
  wheels.set(0.3, -0.15);
  EXPECT_DOUBLE_EQ(ramp.held_back(wheels).left_m_s, 0.1);
  EXPECT_DOUBLE_EQ(ramp.held_back(wheels).right_m_s, -0.05);
  hal::QuadrotorSpeed speed;
  speed.set(0.6, 0.0, 0.8, 0.3);
  EXPECT_NEAR(ramp.held_back(speed).velocity[2], 0.08, 1e-12);
}

TEST(RampLaw, ATargetIsDrawnNearAlongTheLineToIt) {
  hal::QuadrotorPosition wanted;
  wanted.set(3.0, 4.0, 1.0, 0.5);
  const auto near = Ramp{0.5}.held_back(wanted, {0.0, 0.0, 1.0});
  EXPECT_FALSE(near.hold);
  EXPECT_NEAR(near.target[0], 0.3, 1e-12);
  EXPECT_NEAR(near.target[1], 0.4, 1e-12);
  EXPECT_NEAR(near.target[2], 1.0, 1e-12);
  EXPECT_EQ(near.yaw_rad, 0.5);
  EXPECT_EQ(Ramp{6.0}.held_back(wanted, {0.0, 0.0, 1.0}).target[0], 3.0);
  EXPECT_EQ(Ramp{0.0}.held_back(wanted, {0.0, 0.0, 1.0}).target[0], 0.0);
  wanted.hover();
  EXPECT_TRUE(Ramp{0.0}.held_back(wanted, {0.0, 0.0, 1.0}).hold);
}

TEST(RampLaw, WithoutALimitNothingChanges) {
  hal::WheelSpeeds wheels;
  wheels.set(0.3, -0.15);
  EXPECT_EQ(Ramp{}.held_back(wheels).left_m_s, 0.3);
}

}  // namespace
}  // namespace tandem::mixed_reality
