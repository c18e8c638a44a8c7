// The stores are the truth: what changes there counts, what is no number is named.
#include <limits>

#include "tests/core/physics/dynamics2d/by_hand.hpp"

namespace tandem::core {
namespace {

/// Robots and things that meet, push and slide within a few seconds.
void crowd(FlatByHand& hand) {
  for (int i = 0; i < 24; ++i) {
    const double angle = 0.7 * i;
    const double far = 0.12 + 0.018 * i;
    hand.robot(far * std::cos(angle), far * std::sin(angle), angle + M_PI + 0.2, 0.08 + 0.002 * i, 0.1);
  }
  hand.box(0.02, 0.01, 0.1, 0.07, 0.1, 0.4);
  hand.cylinder(0.4, 0.45, 0.05, 0.2);
  hand.box(-0.3, -0.45, 0.2, 0.1, 0.0, 0.2);
}

TEST(Dynamics2dStores, TheSameBitsTwice) {
  FlatByHand one;
  FlatByHand two;
  crowd(one);
  crowd(two);
  for (int i = 0; i < 100; ++i) {
    one.tick();
    two.tick();
    ASSERT_EQ(one.state(), two.state()) << i;
  }
}

TEST(Dynamics2dStores, BodiesAreWhereAHookPutsThem) {
  FlatByHand hand;
  hand.robot(0, 0, 0, 0.1, 0.1);
  hand.box(1, 1, 0.1, 0.1, 0.2);
  hand.ticks(10);
  hand.bodies().x_m[0] = -3.0;
  hand.bodies().cos_h[0] = 0.0;
  hand.bodies().sin_h[0] = 1.0;
  hand.object().y_m = 5.0;
  hand.object_motion().v_m_s = {0.0, 0.5, 0.0};
  hand.tick();
  EXPECT_NEAR(hand.bodies().x_m[0], -3.0, 1e-6);
  EXPECT_NEAR(hand.bodies().y_m[0], 0.01, 1e-4);
  EXPECT_NEAR(hand.object().y_m, 5.0 + 0.05 - 0.75 * 1.49 * kTick_s * kTick_s, 1e-4);  // in two sub-steps
}

TEST(Dynamics2dStores, ARenewedRowIsAnotherRobot) {
  FlatByHand hand;
  hal::RobotKind weak = hal::epuck::kind();
  weak.part<hal::DifferentialDrive>()->force_N = 0.0015;  // 0.01 m/s^2
  hand.robot(0, 0, 0, 0.1, 0.1);
  hand.robot(1, 0, 0, 0.1, 0.1, weak);
  hand.ticks(5);
  // The second robot's entity takes the first row's place, fast as the first one was.
  hand.bodies().flags[0] = 0;
  hand.ticks(2);
  hand.bodies().flags[0] = kAlive;
  hand.bodies().entity[0] = 1;
  hand.bodies().motion[0] = {};
  const double from_m = hand.bodies().x_m[0];
  hand.tick();
  EXPECT_NEAR(hand.bodies().x_m[0] - from_m, 0.01 * kTick_s * kTick_s, 1e-6);
}

TEST(Dynamics2dStores, RobotsThatGoLeaveTheirPlaceFree) {
  FlatByHand hand;
  hand.robot(0, 0, 0, 0.1, 0.1);
  hand.robot(0.2, 0, 0, 0, 0);
  hand.bodies().flags[1] |= kExternal;
  hand.ticks(30);
  EXPECT_NEAR(hand.bodies().x_m[0], 0.2 - 2 * kRadius_m, 1e-3);
  hand.bodies().flags[1] = 0;
  hand.ticks(30);
  EXPECT_NEAR(hand.bodies().x_m[0], 0.2 - 2 * kRadius_m + 0.3, 2e-3);
}

TEST(Dynamics2dStores, WhatIsNoNumberIsNamedAndLeavesOthersAlone) {
  const double nan = std::nan("");
  const double infinite = std::numeric_limits<double>::infinity();
  for (const bool at_once : {true, false}) {
    for (const double bad : {nan, infinite, -infinite, 1e300}) {
      for (int what = 0; what < 6; ++what) {
        FlatByHand hand;
        hand.robot(0.3, 0, 0, 0.05, 0.05);
        hand.robot(0, 0, 0, 0.05, 0.05);
        hand.box(0.5, 0.5, 0.1, 0.1, 0.2);
        if (!at_once) hand.ticks(3);
        BodyKey culprit = BodyKey::robot(1);
        if (what == 0) hand.bodies().x_m[1] = bad;
        if (what == 1) hand.bodies().motion[1].v_m_s[0] = bad;
        if (what == 2) hand.bodies().sin_h[1] = bad;
        if (what > 2) culprit = BodyKey::object(0);
        if (what == 3) hand.object().y_m = bad;
        if (what == 4) hand.object_motion().v_m_s[1] = bad;
        if (what == 5) hand.object_motion().w_rad_s[2] = bad;
        const double from_m = hand.bodies().x_m[0];
        hand.tick();
        const std::string name = std::to_string(what) + " " + hal::format_number(bad) + (at_once ? " at once" : "");
        ASSERT_EQ(hand.trouble.size(), 1U) << name;
        EXPECT_EQ(hand.trouble[0].body, culprit) << name;
        EXPECT_NEAR(hand.bodies().x_m[0], from_m + 0.005, 1e-4) << name;
        EXPECT_EQ(hand.bodies().y_m[0], 0.0) << name;
      }
    }
  }
}

TEST(Dynamics2dStores, WhatIsTooFastIsNamedAndNotWritten) {
  FlatByHand hand;
  hand.box(0, 0, 0.1, 0.1, 0.2);
  hand.object_motion().v_m_s = {1e5, 0, 0};
  hand.tick();
  ASSERT_EQ(hand.trouble.size(), 1U);
  EXPECT_EQ(hand.trouble[0].body, BodyKey::object(0));
  EXPECT_NE(hand.trouble[0].what.find("faster"), std::string::npos) << hand.trouble[0].what;
  EXPECT_EQ(hand.object().x_m, 0.0);
}

}  // namespace
}  // namespace tandem::core
