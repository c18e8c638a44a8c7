// The two drives of robots on wheels.
#include <numbers>

#include "tests/core/physics/dynamics3d/by_hand.hpp"

namespace tandem::core {
namespace {

TEST(Dynamics3dBase, FollowsItsArcExactly) {
  for (const double far_m : {0.0, 900.0}) {
    ByHand hand({{"drive", "base", 3}}, {}, 1000.0);
    hand.robot(far_m, -far_m, 0.7, 0.06, 0.1);
    hand.robot(far_m + 3.0, -far_m, 0.7, 0.1, 0.1);
    hand.tick();  // starts from rest within the first
    const double x_m = hand.bodies().x_m[0];
    const double y_m = hand.bodies().y_m[0];
    const double from_rad = std::atan2(hand.bodies().sin_h[0], hand.bodies().cos_h[0]);
    const double straight_m = hand.bodies().x_m[1];
    hand.ticks(200);
    const double turn_rad = 0.04 / hal::epuck::kind().drive()->wheel_base_m * 20.0;
    const double radius_m = 0.08 * 20.0 / turn_rad;
    EXPECT_NEAR(hand.bodies().x_m[0], x_m + radius_m * (std::sin(from_rad + turn_rad) - std::sin(from_rad)), 1e-8);
    EXPECT_NEAR(hand.bodies().y_m[0], y_m - radius_m * (std::cos(from_rad + turn_rad) - std::cos(from_rad)), 1e-8);
    EXPECT_NEAR(hand.bodies().x_m[1] - straight_m, 2.0 * std::cos(0.7), 1e-8);
    EXPECT_NEAR(hand.bodies().left_m[0], 0.06 * 20.1, 1e-9);
    EXPECT_EQ(hand.bodies().motion[0].z_m, 0.0);
  }
}

TEST(Dynamics3dBase, AcceleratesWithItsForceOverItsMass) {
  hal::RobotKind weak = hal::epuck::kind();
  weak.part<hal::DifferentialDrive>()->force_N = 0.1 * weak.body.mass_kg;
  ByHand hand;
  hand.robot(0, 0, 0.4, 0.1, 0.1, weak);
  for (int i = 1; i <= 15; ++i) {
    hand.tick();
    EXPECT_NEAR(hand.speed_m_s(0), std::min(0.1, 0.1 * kTick_s * i), 1e-9) << i;
  }
}

TEST(Dynamics3dBase, FallsFromABoxThatEnds) {
  ByHand hand;
  hand.block(0, 0, 0, 1.0, 1.0, 0.3, 0.0);
  hand.robot(0.3, 0, 0, 0.1, 0.1);
  hand.bodies().motion[0].z_m = 0.3;
  hand.ticks(10);
  EXPECT_NEAR(hand.bodies().motion[0].z_m, 0.3, 1e-3);
  hand.ticks(30);
  EXPECT_EQ(hand.bodies().motion[0].z_m, 0.0);
  EXPECT_GT(hand.bodies().x_m[0], 0.5 + kRadius_m - 1e-3);
}

TEST(Dynamics3dWheels, RollAsTheyAreToldAndStandUpright) {
  ByHand hand({{"drive", "wheels", 3}});
  hand.robot(0, 0, 0, 0.08, 0.08);
  hand.robot(0, 1, 0, -0.04, 0.04);
  hand.ticks(20);
  const double from_m = hand.bodies().x_m[0];
  const double rolled_m = hand.bodies().left_m[0];
  double turned_rad = 0.0;
  double last_rad = std::atan2(hand.bodies().sin_h[1], hand.bodies().cos_h[1]);
  for (int i = 0; i < 100; ++i) {
    hand.tick();
    const double now_rad = std::atan2(hand.bodies().sin_h[1], hand.bodies().cos_h[1]);
    turned_rad += std::remainder(now_rad - last_rad, 2.0 * std::numbers::pi);
    last_rad = now_rad;
    for (const std::size_t row : {0U, 1U}) {
      const auto& q = hand.bodies().motion[row].q_WB;
      ASSERT_GT(1.0 - 2.0 * (q[1] * q[1] + q[2] * q[2]), 0.999) << row << " in tick " << i;
      ASSERT_NEAR(hand.bodies().motion[row].z_m, 0.0, 1e-3) << row << " in tick " << i;
    }
  }
  EXPECT_NEAR(hand.bodies().x_m[0] - from_m, 0.8, 0.016);
  EXPECT_NEAR(hand.bodies().y_m[0], 0.0, 0.01);
  EXPECT_NEAR(hand.bodies().left_m[0] - rolled_m, 0.8, 0.016);
  EXPECT_NEAR(turned_rad, 0.08 / hal::epuck::kind().drive()->wheel_base_m * 10.0,
              0.03 * 0.08 / hal::epuck::kind().drive()->wheel_base_m * 10.0);
  EXPECT_NEAR(hand.bodies().x_m[1], 0.0, 0.01);
  EXPECT_TRUE(hand.trouble.empty());
}

TEST(Dynamics3dWheels, SlipWithoutFriction) {
  ByHand hand({{"drive", "wheels", 3}, {"wheel_friction", "0", 3}});
  hand.robot(0, 0, 0, 0.08, 0.08);
  hand.ticks(50);
  EXPECT_NEAR(hand.bodies().x_m[0], 0.0, 0.01);
  EXPECT_NEAR(hand.bodies().left_m[0], 0.4, 0.02);  // they turn all the same
}

}  // namespace
}  // namespace tandem::core
