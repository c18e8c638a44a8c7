// Gravity, the floor, and what stands, slides and topples on it.
#include <algorithm>
#include <ctime>

#include "tests/core/physics/dynamics3d/by_hand.hpp"

namespace tandem::core {
namespace {

TEST(Dynamics3dFalling, FollowsTheClosedForm) {
  for (const double g_m_s2 : {9.81, 1.62}) {
    ByHand hand({}, {child("gravity", {{"g", hal::format_number(g_m_s2), 4}})});
    hand.block(0, 0, 20.0, 0.1, 0.2, 0.3, 0.7);
    hand.can(1, 0, 20.0, 0.05, 0.1, 0.2);
    hand.object_motion(0).v_m_s = {0.3, 0.0, 2.0};
    for (int i = 1; i <= 15; ++i) {
      hand.tick();
      const double t_s = kTick_s * i;
      // Velocities change at the start of a sub-step: after t, that is g t h / 2 more than the parabola.
      const double late_m = 0.5 * g_m_s2 * t_s * kSubStep_s;
      ASSERT_NEAR(hand.z_m(0), 20.0 + 2.0 * t_s - 0.5 * g_m_s2 * t_s * t_s - late_m, 1e-9) << i;
      ASSERT_NEAR(hand.z_m(1), 20.0 - 0.5 * g_m_s2 * t_s * t_s - late_m, 1e-9) << i;
      ASSERT_NEAR(hand.object(0).x_m, 0.3 * t_s, 1e-9) << i;
      ASSERT_NEAR(hand.object_motion(0).v_m_s[2], 2.0 - g_m_s2 * t_s, 1e-9) << i;
      ASSERT_EQ(hand.object(0).z_low_m, hand.z_m(0)) << i;
      ASSERT_NEAR(hand.object(0).z_high_m - hand.z_m(0), 0.3, 1e-12) << i;
    }
  }
}

TEST(Dynamics3dFalling, NothingFallsWithoutGravity) {
  ByHand hand({}, {child("gravity", {{"g", "0", 4}})});
  hand.block(0, 0, 1.0, 0.1, 0.1, 0.1, 0.5);
  hand.object_motion().w_rad_s = {0, 0, 1.0};
  hand.ticks(50);
  EXPECT_NEAR(hand.z_m(), 1.0, 1e-12);
  EXPECT_NEAR(hand.object_motion().w_rad_s[2], 1.0, 1e-9);
}

TEST(Dynamics3dFalling, EndsOnTheFloorWhereverThatIs) {
  for (const double floor_m : {0.0, 0.5, -2.0}) {
    ByHand hand({}, {child("floor", {{"height", hal::format_number(floor_m), 4}})});
    hand.block(0, 0, floor_m + 0.4, 0.1, 0.1, 0.1, 0.5);
    hand.can(1, 0, floor_m + 0.4, 0.05, 0.1, 0.5);
    for (int i = 0; i < 40; ++i) {
      hand.tick();
      ASSERT_GE(hand.z_m(0), floor_m - 1e-3) << i;
      ASSERT_GE(hand.z_m(1), floor_m - 1e-3) << i;
    }
    EXPECT_NEAR(hand.z_m(0), floor_m, 1e-3);
    EXPECT_NEAR(hand.z_m(1), floor_m, 1e-3);
    EXPECT_NEAR(hand.upright(0), 1.0, 1e-6);
    EXPECT_NEAR(hand.upright(1), 1.0, 1e-6);
  }
}

/// Stacks as people build them: untouched they stay as they are.
TEST(Dynamics3dFalling, AStackStands) {
  for (const bool aside : {false, true}) {
    ByHand hand;
    constexpr int kBoxes = 8;
    for (int i = 0; i < kBoxes; ++i)
      hand.block(aside ? 0.01 * (i % 2) : 0.0, 0.0, 0.1 * i, 0.1, 0.1, 0.1, 0.5, aside ? 0.2 * i : 0.0);
    for (int i = 0; i < 3000; ++i) {
      hand.tick();
      for (int k = 0; k < kBoxes; ++k) {
        const auto number = static_cast<std::size_t>(k);
        ASSERT_NEAR(hand.z_m(number), 0.1 * k, 2e-3) << "box " << k << " after " << 0.1 * i << " s";
        ASSERT_NEAR(hand.object(number).x_m, aside ? 0.01 * (k % 2) : 0.0, 2e-3) << k << " after " << 0.1 * i << " s";
        ASSERT_GT(hand.upright(number), 0.9999) << "box " << k << " after " << 0.1 * i << " s";
      }
    }
  }
}

/// Bricks that each stick out over the one below by 1/(2n) of their length, the top one first, just stand.
TEST(Dynamics3dFalling, OverhangingBricksStandUpToTheClosedForm) {
  for (const double share : {0.95, 1.05}) {
    ByHand hand;
    constexpr int kBricks = 5;
    constexpr double kLength_m = 0.2;
    double x_m = 0.0;
    for (int i = 0; i < kBricks; ++i) {
      hand.block(x_m, 0.0, 0.05 * i, kLength_m, 0.1, 0.05, 0.5);
      x_m += share * kLength_m / 2.0 / (kBricks - 1 - i);
    }
    hand.ticks(300);
    const bool stands = share < 1.0;
    for (int i = 0; i < kBricks; ++i) {
      if (stands) {
        EXPECT_NEAR(hand.z_m(static_cast<std::size_t>(i)), 0.05 * i, 1e-6);
      }
    }
    if (!stands) {
      EXPECT_LT(hand.z_m(kBricks - 1), 0.15);
    }
  }
}

TEST(Dynamics3dFalling, WhatWasDroppedComesToRest) {
  ByHand hand;
  for (int i = 0; i < 4; ++i) hand.block(0.003 * i, 0.0, 0.1 * i + 0.02 * (i + 1), 0.1, 0.1, 0.1, 0.5, 0.1 * i);
  hand.ticks(50);
  std::vector<double> places;
  for (std::size_t i = 0; i < 4; ++i) {
    places.push_back(hand.object(i).x_m);
    places.push_back(hand.z_m(i));
    EXPECT_EQ(hand.object_motion(i).v_m_s, (std::array<double, 3>{})) << i;
  }
  hand.ticks(500);
  for (std::size_t i = 0; i < 4; ++i) {
    EXPECT_EQ(hand.object(i).x_m, places[2 * i]);
    EXPECT_EQ(hand.z_m(i), places[2 * i + 1]);
  }
}

TEST(Dynamics3dFalling, ABoxThatFallsOnABoxComesToLieOnIt) {
  for (const double turned_rad : {0.0, 0.2}) {
    for (const double drop_m : {0.05, 0.3, 0.5}) {
      ByHand hand;
      hand.block(0.0, 0.0, 0.0, 0.2, 0.2, 0.1, 0.5);
      hand.block(0.03, 0.02, 0.1 + drop_m, 0.1, 0.1, 0.1, 0.3, turned_rad);
      hand.ticks(80);
      EXPECT_NEAR(hand.z_m(1), 0.1, 1e-3) << drop_m << " " << turned_rad;
      EXPECT_NEAR(hand.upright(1), 1.0, 1e-4) << drop_m << " " << turned_rad;
      EXPECT_NEAR(hand.z_m(0), 0.0, 1e-3) << drop_m << " " << turned_rad;
    }
  }
}

TEST(Dynamics3dFalling, AStackFallsWhenItsFootGoes) {
  ByHand hand;
  for (int i = 0; i < 3; ++i) hand.block(0.0, 0.0, 0.1 * i, 0.1, 0.1, 0.1, 0.5);
  hand.ticks(20);
  hand.object(0).x_m += 0.5;  // a hook takes it away
  hand.ticks(10);
  EXPECT_NEAR(hand.z_m(1), 0.0, 2e-3);
  EXPECT_NEAR(hand.z_m(2), 0.1, 5e-3);
}

TEST(Dynamics3dFalling, ARegionsBottomIsAFloor) {
  ByHand hand;
  hand.region();
  hand.stores().regions[0].bottom_m = 1.0;
  hand.block(0, 0, 1.5, 0.1, 0.1, 0.1, 0.5);
  hand.ticks(30);
  EXPECT_NEAR(hand.z_m(), 1.0, 1e-3);
}

TEST(Dynamics3dResting, NeitherCreepsNorSinksInAMinute) {
  ByHand hand;
  hand.block(0, 0, 0, 0.1, 0.2, 0.3, 0.7, 0.3);
  hand.can(1, 0, 0, 0.05, 0.1, 0.2);
  hand.block(2, 0, 0, 0.1, 0.1, 0.1, 0.5);    // carries
  hand.block(2, 0, 0.1, 0.1, 0.1, 0.1, 0.5);  // … this one
  hand.can(3, 0, 0, 0.06, 0.05, 0.3);
  hand.can(3, 0.01, 0.05, 0.05, 0.05, 0.3);
  const std::vector<Object> before = hand.stores().objects;
  hand.ticks(600);
  for (std::size_t i = 0; i < before.size(); ++i) {
    // ODE's passes leave a stack of boxes, whose contacts are redundant, a micrometre a sub-step to creep.
    const double bar_m = i == 2 || i == 3 ? 5e-3 : 1e-3;
    EXPECT_NEAR(hand.object(i).x_m, before[i].x_m, bar_m) << i;
    EXPECT_NEAR(hand.object(i).y_m, before[i].y_m, bar_m) << i;
    EXPECT_NEAR(hand.object(i).z_low_m, before[i].z_low_m, 2e-3) << i;
    EXPECT_NEAR(hand.object(i).sin_h, before[i].sin_h, 5e-3) << i;
    EXPECT_NEAR(hand.upright(i), 1.0, 1e-4) << i;
  }
}

/// Processor time of one tick with so many boxes that stand side by side, the least of three.
double seconds_with_boxes(int boxes) {
  ByHand hand({}, {}, 100.0);
  for (int i = 0; i < boxes; ++i) hand.block(0.3 * (i % 90) - 13.5, 0.3 * (i / 90) - 13.5, 0.0, 0.1, 0.1, 0.1, 0.5);
  hand.ticks(2);
  double least_s = 1e9;
  for (int i = 0; i < 3; ++i) {
    timespec from{}, to{};
    clock_gettime(CLOCK_THREAD_CPUTIME_ID, &from);
    hand.tick();
    clock_gettime(CLOCK_THREAD_CPUTIME_ID, &to);
    least_s = std::min(
        least_s, static_cast<double>(to.tv_sec - from.tv_sec) + 1e-9 * static_cast<double>(to.tv_nsec - from.tv_nsec));
  }
  return least_s;
}

/// Four times as many heaps cost four times as much, and what caches lack; compared with one another they would cost
/// sixteen times as much or more.
TEST(Dynamics3dResting, CostsEveryBoxTheSameHoweverManyThereAre) {
  EXPECT_LT(seconds_with_boxes(8000), 10.0 * seconds_with_boxes(2000));
}

TEST(Dynamics3dSliding, IsBrakedByCoulombsFriction) {
  for (const double friction : {0.1, 0.4}) {
    ByHand hand({}, {child("floor", {{"friction", hal::format_number(friction), 4}})});
    hand.block(0, 0, 0, 0.3, 0.3, 0.05, 0.7);
    hand.object_motion().v_m_s = {0.6, 0.8, 0.0};
    double most_m_s = 1.0;
    for (int i = 1; i <= 40; ++i) {
      hand.tick();
      const auto& v = hand.object_motion().v_m_s;
      most_m_s = std::max(0.0, 1.0 - friction * kGravity_m_s2 * kTick_s * i);
      ASSERT_NEAR(std::hypot(v[0], v[1]), most_m_s, 0.02) << i;
    }
    const double way_m = 1.0 / (2.0 * friction * kGravity_m_s2);
    EXPECT_NEAR(std::hypot(hand.object().x_m, hand.object().y_m), way_m, 0.03 * way_m + 0.5 * kSubStep_s) << friction;
    EXPECT_NEAR(hand.object().x_m * 0.8, hand.object().y_m * 0.6, 0.01) << friction;
    EXPECT_NEAR(hand.upright(), 1.0, 1e-4);
  }
}

TEST(Dynamics3dToppling, NeedsTheEnergyThatLiftsItOverItsEdge) {
  // A box that turns about its lower edge must lift its middle from half its height to half its diagonal.
  constexpr double kHalf_m = 0.04;
  constexpr double kTall_m = 0.10;
  const double diagonal_m = std::hypot(kHalf_m, kTall_m);
  const double needed_rad_s = std::sqrt(2.0 * kGravity_m_s2 * (diagonal_m - kTall_m) / (4.0 / 3.0)) / diagonal_m;
  for (const double share : {0.7, 1.4}) {
    ByHand hand;
    hand.block(0, 0, 0, 2 * kHalf_m, 0.2, 2 * kTall_m, 0.5);
    const double w = share * needed_rad_s;
    hand.object_motion().w_rad_s = {0, w, 0};  // forwards, about the edge at x = +half
    hand.object_motion().v_m_s = {w * kTall_m, 0, w * kHalf_m};
    hand.ticks(60);
    if (share < 1.0) {
      EXPECT_NEAR(hand.upright(), 1.0, 1e-3);
      EXPECT_NEAR(hand.z_m(), 0.0, 1e-3);
    } else {
      EXPECT_NEAR(hand.upright(), 0.0, 0.01);
      EXPECT_NEAR(hand.z_m(), kHalf_m - kTall_m, 3e-3);  // of the box's base, along its own axis
      EXPECT_GT(hand.object().x_m, kHalf_m);
    }
    EXPECT_TRUE(hand.trouble.empty());
  }
}

TEST(Dynamics3dPushing, ARobotShovesAFlatBoxAlongAndStaysUpright) {
  ByHand hand;
  hand.robot(-0.2, 0, 0, 0.1, 0.1);
  hand.block(0, 0, 0, 0.1, 0.2, 0.05, 0.1);
  hand.ticks(50);
  EXPECT_NEAR(hand.object().x_m - 0.05 - kRadius_m, hand.bodies().x_m[0], 3e-3);
  EXPECT_GT(hand.object().x_m, 0.2);
  EXPECT_NEAR(hand.upright(), 1.0, 1e-3);
  EXPECT_NEAR(hand.bodies().motion[0].z_m, 0.0, 1e-9);
}

TEST(Dynamics3dPushing, AnythingHeavierThanTheDriveCanMoveStays) {
  ByHand hand;
  hand.robot(-0.2, 0, 0, 0.1, 0.1);
  hand.block(0, 0, 0, 0.1, 0.2, 0.05, 20.0);
  hand.ticks(100);
  EXPECT_NEAR(hand.object().x_m, 0.0, 2e-3);
  EXPECT_NEAR(hand.bodies().x_m[0], -0.05 - kRadius_m, 2e-3);
}

}  // namespace
}  // namespace tandem::core
