// Bodies held together, whichever way they point and on whichever side of a border.
#include "tests/core/physics/dynamics2d/by_hand.hpp"

namespace tandem::core {
namespace {

/// Distance between a joint's point as its two bodies have it.
double apart_m(FlatByHand& hand, std::size_t number = 0) {
  const Joint& j = hand.stores().joints[number];
  const auto point = [&](BodyKey key, double x, double y) {
    const std::size_t i = key.index();
    const bool object = key.is_object();
    const double c = object ? hand.object(i).cos_h : hand.bodies().cos_h[i];
    const double s = object ? hand.object(i).sin_h : hand.bodies().sin_h[i];
    return std::pair{(object ? hand.object(i).x_m : hand.bodies().x_m[i]) + c * x - s * y,
                     (object ? hand.object(i).y_m : hand.bodies().y_m[i]) + s * x + c * y};
  };
  const auto [px, py] = point(j.a, j.ax_m, j.ay_m);
  const auto [qx, qy] = point(j.b, j.bx_m, j.by_m);
  return std::hypot(px - qx, py - qy);
}

TEST(Dynamics2dJoints, HoldWhateverTheTwoHeadings) {
  for (const double robot_rad : {-3.1, -2.0, 0.1, 2.5, 3.1}) {
    for (const double box_rad : {-3.0, -1.0, 0.7, 3.1}) {
      FlatByHand hand;
      hand.robot(0, 0, robot_rad, -0.05, -0.05);
      const double reach_m = kRadius_m + 0.03;
      hand.cylinder(reach_m * std::cos(robot_rad), reach_m * std::sin(robot_rad), 0.03, 0.05);
      hand.object().cos_h = std::cos(box_rad);
      hand.object().sin_h = std::sin(box_rad);
      const BodyKey a = BodyKey::robot(0);
      const BodyKey b = BodyKey::object(0);
      hand.hold(a, b, kRadius_m * std::cos(robot_rad), kRadius_m * std::sin(robot_rad));
      const double relative_rad = hand.relative_heading_rad(a, b);
      for (int i = 0; i < 40; ++i) {
        hand.tick();
        ASSERT_LE(apart_m(hand), 1e-3) << robot_rad << " " << box_rad << " " << i;
        ASSERT_NEAR(std::remainder(hand.relative_heading_rad(a, b) - relative_rad, 2 * M_PI), 0.0, 0.02)
            << robot_rad << " " << box_rad << " " << i;
      }
      EXPECT_NEAR(hand.bodies().x_m[0], -0.2 * std::cos(robot_rad), 5e-3) << robot_rad;
      EXPECT_NEAR(hand.bodies().y_m[0], -0.2 * std::sin(robot_rad), 5e-3) << robot_rad;
    }
  }
}

TEST(Dynamics2dJoints, HoldThroughManyTurns) {
  FlatByHand hand;
  hand.robot(0, 0, 0, -0.06, 0.06);
  hand.cylinder(kRadius_m + 0.02, 0, 0.02, 0.01);
  hand.hold(BodyKey::robot(0), BodyKey::object(0), kRadius_m, 0);
  double turned_rad = 0.0;
  double last_rad = 0.0;
  for (int i = 0; i < 2000; ++i) {
    hand.tick();
    const double now_rad = std::atan2(hand.bodies().sin_h[0], hand.bodies().cos_h[0]);
    turned_rad += std::remainder(now_rad - last_rad, 2 * M_PI);
    last_rad = now_rad;
    ASSERT_LE(apart_m(hand), 2e-3) << i;
    ASSERT_NEAR(hand.relative_heading_rad(BodyKey::robot(0), BodyKey::object(0)), 0.0, 0.02) << i;
    if (i == 1000) ++hand.stores().joints[0].generation;  // made anew
  }
  EXPECT_GT(turned_rad, 300.0);
  EXPECT_TRUE(hand.trouble.empty());
}

TEST(Dynamics2dJoints, AnObjectThatMayTurnDoes) {
  FlatByHand hand({{"box_angular_friction", "0", 0}});
  hand.robot(0, 0, 0, -0.03, 0.03);
  hand.box(kRadius_m + 0.03, 0, 0.06, 0.06, 0.02);
  hand.hold(BodyKey::robot(0), BodyKey::object(0), kRadius_m, 0, {.kind = JointKind::Turning});
  double lag_rad = 0.0;
  for (int i = 0; i < 20; ++i) {
    hand.tick();
    ASSERT_LE(apart_m(hand), 2e-3) << i;
    lag_rad = std::max(lag_rad, std::fabs(hand.relative_heading_rad(BodyKey::robot(0), BodyKey::object(0))));
  }
  EXPECT_GT(lag_rad, 0.2);
}

TEST(Dynamics2dJoints, WhatARealRobotHoldsGoesAndTurnsWithIt) {
  FlatByHand hand;
  hand.robot(0, 0, 0, 0, 0);
  hand.cylinder(kRadius_m + 0.02, 0, 0.02, 0.05);
  hand.bodies().flags[0] |= kExternal;
  hand.hold(BodyKey::robot(0), BodyKey::object(0), kRadius_m, 0);
  for (int i = 1; i <= 60; ++i) {
    hand.bodies().x_m[0] = 0.005 * i;
    hand.bodies().cos_h[0] = std::cos(0.1 * i);
    hand.bodies().sin_h[0] = std::sin(0.1 * i);
    hand.tick();
    ASSERT_LE(apart_m(hand), 0.015) << i;  // the joint lags by less than a tick's way
  }
  hand.ticks(5);
  EXPECT_LE(apart_m(hand), 2e-3);
  EXPECT_NEAR(hand.relative_heading_rad(BodyKey::robot(0), BodyKey::object(0)), 0.0, 0.05);
}

TEST(Dynamics2dJoints, EndWhenTheyDoAndWithEitherBody) {
  for (const bool by_hand : {true, false}) {
    FlatByHand hand;
    hand.robot(0, 0, 0, -0.1, -0.1);
    hand.box(kRadius_m + 0.05, 0, 0.1, 0.1, 0.1);
    hand.hold(BodyKey::robot(0), BodyKey::object(0), kRadius_m, 0);
    hand.ticks(20);
    EXPECT_LE(apart_m(hand), 1e-3);
    if (by_hand)
      hand.stores().joints[0].alive = false;
    else
      hand.bodies().flags[0] = 0;
    const double from_m = hand.object().x_m;
    hand.ticks(20);
    EXPECT_NEAR(hand.object().x_m, from_m, 0.015) << by_hand;
    if (by_hand) {
      EXPECT_LT(hand.bodies().x_m[0], -0.35);
    }
  }
}

TEST(Dynamics2dJoints, HoldAcrossABorder) {
  // Both stay with the west, which owns the robot; the east has the two as mirrored ones.
  FlatByHand hand;
  hand.region(west_half());
  hand.region(east_half());
  hand.robot(-0.2, 0, 0, 0.1, 0.1);
  hand.box(-0.2 + kRadius_m + 0.05, 0, 0.1, 0.1, 0.1);
  hand.hold(BodyKey::robot(0), BodyKey::object(0), -0.2 + kRadius_m, 0);
  for (int i = 0; i < 50; ++i) {
    hand.tick();
    ASSERT_LE(apart_m(hand), 1e-3) << i;
    ASSERT_NEAR(hand.bodies().x_m[0], -0.2 + 0.01 * (i + 1), 3e-3) << i;
  }
  EXPECT_TRUE(hand.trouble.empty());
}

TEST(Dynamics2dJoints, AChainOfManyKeepsTogether) {
  FlatByHand hand;
  constexpr std::size_t kMany = 12;
  for (std::size_t i = 0; i < kMany; ++i) hand.robot(-0.075 * static_cast<double>(i), 0, 0, 0.1, 0.1);
  for (std::size_t i = 1; i < kMany; ++i)
    hand.hold(BodyKey::robot(i - 1), BodyKey::robot(i), -0.075 * (static_cast<double>(i) - 0.5), 0,
              {.kind = JointKind::Turning});
  hand.ticks(50);
  for (std::size_t i = 0; i + 1 < kMany; ++i) EXPECT_LE(apart_m(hand, i), 1e-3) << i;
  EXPECT_NEAR(hand.bodies().x_m[0], 0.5, 0.01);
  // The middle one lets go: the rear stops, the front goes on.
  hand.stores().joints[kMany / 2].alive = false;
  for (std::size_t i = kMany / 2 + 1; i < kMany; ++i) hand.bodies().left_m_s[i] = hand.bodies().right_m_s[i] = 0.0;
  hand.ticks(50);
  EXPECT_NEAR(hand.bodies().x_m[0], 1.0, 0.02);
  EXPECT_NEAR(hand.bodies().x_m[kMany - 1], 0.5 - 0.075 * (kMany - 1), 0.02);
}

}  // namespace
}  // namespace tandem::core
