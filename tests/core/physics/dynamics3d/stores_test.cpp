// The stores are the truth: the same stores give the same bits, what is no number is named, caches may be forgotten.
#include <limits>
#include <thread>

#include "tests/core/physics/dynamics3d/by_hand.hpp"

namespace tandem::core {
namespace {

/// Robots and things that meet, push, fall on one another and slide within a few seconds.
void crowd(ByHand& hand) {
  for (int i = 0; i < 20; ++i) {
    const double angle = 0.7 * i;
    const double far = 0.14 + 0.02 * i;
    hand.robot(far * std::cos(angle), far * std::sin(angle), angle + M_PI + 0.2, 0.08 + 0.002 * i, 0.1);
  }
  hand.block(0.02, 0.01, 0, 0.1, 0.07, 0.05, 0.1, 0.4);
  hand.block(0.03, 0.02, 0.3, 0.1, 0.05, 0.06, 0.1, 0.9);
  hand.can(0.4, 0.45, 0, 0.05, 0.1, 0.2);
  hand.object_motion(1).w_rad_s = {3.0, 1.0, 0.0};
}

TEST(Dynamics3dStores, TheSameBitsTwiceAndOnAnyThread) {
  ByHand one;
  ByHand two;
  crowd(one);
  crowd(two);
  for (int i = 0; i < 60; ++i) {
    one.tick();
    if (i % 3 == 0)
      std::thread([&] { two.tick(); }).join();  // ODE keeps its random numbers and its data for each thread
    else
      two.tick();
    ASSERT_EQ(one.state(), two.state()) << i;
  }
}

TEST(Dynamics3dStores, TwoSolversAtOnceDoNotDisturbOneAnother) {
  // Both threads are ODE's first ones if this test runs alone.
  ByHand one;
  ByHand two;
  ByHand alone;
  for (ByHand* hand : {&one, &two, &alone}) crowd(*hand);
  std::thread first([&] { one.ticks(30); });
  std::thread second([&] { two.ticks(30); });
  first.join();
  second.join();
  alone.ticks(30);
  EXPECT_EQ(one.state(), alone.state());
  EXPECT_EQ(two.state(), alone.state());
}

TEST(Dynamics3dStores, WhatIsNoNumberIsNamedAndLeavesOthersAlone) {
  const double infinite = std::numeric_limits<double>::infinity();
  for (const bool at_once : {true, false}) {
    for (const double bad : {std::nan(""), infinite, -infinite}) {
      for (int what = 0; what < 7; ++what) {
        ByHand hand;
        hand.robot(0.3, 0, 0, 0.05, 0.05);
        hand.robot(0, 0, 0, 0.05, 0.05);
        hand.block(0.5, 0.5, 0, 0.1, 0.1, 0.1, 0.2);
        hand.ticks(at_once ? 0 : 3);
        BodyKey culprit = BodyKey::robot(1);
        if (what == 0) hand.bodies().x_m[1] = bad;
        if (what == 1) hand.bodies().motion[1].v_m_s[0] = bad;
        if (what == 2) hand.bodies().motion[1].z_m = bad;
        if (what > 2) culprit = BodyKey::object(0);
        if (what == 3) hand.object().y_m = bad;
        if (what == 4) hand.object_motion().v_m_s[1] = bad;
        if (what == 5) hand.object_motion().w_rad_s[2] = bad;
        if (what == 6) hand.object_motion().q_WB[1] = bad;
        const double from_m = hand.bodies().x_m[0];
        hand.tick();
        const std::string name = std::to_string(what) + " " + hal::format_number(bad) + (at_once ? " at once" : "");
        ASSERT_EQ(hand.trouble.size(), 1U) << name;
        EXPECT_EQ(hand.trouble[0].body, culprit) << name;
        EXPECT_NEAR(hand.bodies().x_m[0], from_m + 0.005, 1e-3) << name;
        EXPECT_EQ(hand.bodies().y_m[0], 0.0) << name;
      }
    }
  }
}

TEST(Dynamics3dStores, WhatIsTooFastIsNamed) {
  ByHand hand;
  hand.block(0, 0, 0, 0.1, 0.1, 0.1, 0.2);
  hand.object_motion().v_m_s = {1e5, 0, 0};
  hand.tick();
  ASSERT_EQ(hand.trouble.size(), 1U);
  EXPECT_EQ(hand.trouble[0].body, BodyKey::object(0));
  EXPECT_NE(hand.trouble[0].what.find("faster"), std::string::npos) << hand.trouble[0].what;
  EXPECT_EQ(hand.object().x_m, 0.0);
}

TEST(Dynamics3dStores, WhatHasNoSizeIsNamedAndNotSimulated) {
  ByHand hand;
  hand.robot(0, 0, 0, 0.1, 0.1);
  hand.block(1, 1, 0, 0.0, 0.0, 0.0, 0.2);
  hand.ticks(10);
  ASSERT_GE(hand.trouble.size(), 1U);
  EXPECT_EQ(hand.trouble[0].body, BodyKey::object(0));
  EXPECT_NEAR(hand.bodies().x_m[0], 0.1, 0.01);
}

}  // namespace
}  // namespace tandem::core
