// Bodies held together in space.
#include "tests/core/physics/dynamics3d/by_hand.hpp"

namespace tandem::core {
namespace {

/// Distance between a joint's point as its two bodies have it, seen from above.
double apart_m(ByHand& hand) {
  const Joint& j = hand.stores().joints[0];
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

TEST(Dynamics3dJoints, HoldWhateverTheTwoHeadings) {
  for (const double robot_rad : {-3.1, 0.1, 2.5}) {
    for (const double can_rad : {-3.0, -1.0, 0.7}) {
      ByHand hand;
      hand.robot(0, 0, robot_rad, -0.05, -0.05);
      const double reach_m = kRadius_m + 0.03;
      hand.block(reach_m * std::cos(robot_rad), reach_m * std::sin(robot_rad), 0, 0.03, 0.03, 0.05, 0.05, can_rad);
      const BodyKey a = BodyKey::robot(0);
      const BodyKey b = BodyKey::object(0);
      hand.hold(a, b, kRadius_m * std::cos(robot_rad), kRadius_m * std::sin(robot_rad));
      const double relative_rad = hand.relative_heading_rad(a, b);
      for (int i = 0; i < 40; ++i) {
        hand.tick();
        ASSERT_LE(apart_m(hand), 2e-3) << robot_rad << " " << can_rad << " " << i;
        ASSERT_NEAR(std::remainder(hand.relative_heading_rad(a, b) - relative_rad, 2 * M_PI), 0.0, 0.03)
            << robot_rad << " " << can_rad << " " << i;
      }
      EXPECT_NEAR(hand.bodies().x_m[0], -0.2 * std::cos(robot_rad), 0.01) << robot_rad;
      EXPECT_NEAR(hand.bodies().y_m[0], -0.2 * std::sin(robot_rad), 0.01) << robot_rad;
      EXPECT_NEAR(hand.z_m(), 0.0, 1e-3) << robot_rad;
    }
  }
}

TEST(Dynamics3dJoints, HoldThroughManyTurns) {
  ByHand hand;
  hand.robot(0, 0, 0, -0.05, 0.05);
  hand.can(kRadius_m + 0.02, 0, 0, 0.015, 0.05, 0.01);
  hand.hold(BodyKey::robot(0), BodyKey::object(0), kRadius_m, 0);
  double turned_rad = 0.0;
  double last_rad = 0.0;
  for (int i = 0; i < 1000; ++i) {
    hand.tick();
    const double now_rad = std::atan2(hand.bodies().sin_h[0], hand.bodies().cos_h[0]);
    turned_rad += std::remainder(now_rad - last_rad, 2 * M_PI);
    last_rad = now_rad;
    ASSERT_LE(apart_m(hand), 2e-3) << i;
    ASSERT_NEAR(hand.relative_heading_rad(BodyKey::robot(0), BodyKey::object(0)), 0.0, 0.1) << i;
    if (i == 500) ++hand.stores().joints[0].generation;  // made anew
  }
  EXPECT_GT(turned_rad, 100.0);
  EXPECT_NEAR(hand.relative_heading_rad(BodyKey::robot(0), BodyKey::object(0)), 0.0, 0.01);  // it does not add up
  EXPECT_TRUE(hand.trouble.empty());
}

TEST(Dynamics3dJoints, EndWhenTheyDo) {
  ByHand hand;
  hand.robot(0, 0, 0, -0.1, -0.1);
  hand.block(kRadius_m + 0.05, 0, 0, 0.1, 0.1, 0.05, 0.05);
  hand.hold(BodyKey::robot(0), BodyKey::object(0), kRadius_m, 0);
  hand.ticks(20);
  EXPECT_LE(apart_m(hand), 2e-3);
  hand.stores().joints[0].alive = false;
  const double from_m = hand.object().x_m;
  hand.ticks(20);
  EXPECT_NEAR(hand.object().x_m, from_m, 0.015);
  EXPECT_LT(hand.bodies().x_m[0], -0.35);
}

}  // namespace
}  // namespace tandem::core
