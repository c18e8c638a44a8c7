// How the ground holds movable objects, and what walls and immovable objects do.
#include "tests/core/physics/dynamics2d/by_hand.hpp"

namespace tandem::core {
namespace {

/// What is left of a speed after `ticks` of being braked by `per_s2`: the ground takes its share before the body moves.
double left_of(double speed, double per_s2, int ticks) {
  return std::max(0.0, speed - per_s2 * kTick_s * ticks);
}

TEST(Dynamics2dGround, SlidingIsBrakedByTheForcePerKilogram) {
  for (const double per_kg_N : {0.2, 1.49}) {
    FlatByHand hand({{"box_linear_friction", hal::format_number(per_kg_N), 0},
                     {"cylinder_linear_friction", hal::format_number(2 * per_kg_N), 0}});
    hand.box(0, 0, 0.1, 0.2, 0.7, 0.3);
    hand.cylinder(0, 1, 0.1, 0.4);
    hand.object_motion(0).v_m_s = {0.3, 0.4, 0.0};
    hand.object_motion(1).v_m_s = {-0.5, 0.0, 0.0};
    for (int i = 1; i <= 30; ++i) {
      hand.tick();
      const auto& box = hand.object_motion(0).v_m_s;
      const auto& round = hand.object_motion(1).v_m_s;
      ASSERT_NEAR(std::hypot(box[0], box[1]), left_of(0.5, per_kg_N, i), 1e-5) << i;
      ASSERT_NEAR(box[0] * 4, box[1] * 3, 1e-5) << i;
      ASSERT_NEAR(-round[0], left_of(0.5, 2 * per_kg_N, i), 1e-5) << i;
    }
  }
}

TEST(Dynamics2dGround, TurningIsBrakedByTheTorquePerKilogram) {
  // Moment of inertia per kg: (a^2 + b^2) / 12 of a box, r^2 / 2 of a cylinder.
  FlatByHand hand({{"box_angular_friction", "0.01", 0}, {"cylinder_angular_friction", "0.02", 0}});
  hand.box(0, 0, 0.3, 0.4, 0.7);
  hand.cylinder(0, 1, 0.2, 0.4);
  hand.object_motion(0).w_rad_s = {0, 0, 2.0};
  hand.object_motion(1).w_rad_s = {0, 0, -3.0};
  for (int i = 1; i <= 60; ++i) {
    hand.tick();
    ASSERT_NEAR(hand.object_motion(0).w_rad_s[2], left_of(2.0, 0.01 * 12 / 0.25, i), 1e-4) << i;
    ASSERT_NEAR(-hand.object_motion(1).w_rad_s[2], left_of(3.0, 0.02 * 2 / 0.04, i), 1e-4) << i;
  }
}

TEST(Dynamics2dGround, WithoutATorqueTheWeightSpreadEvenlyBrakesTurning) {
  // Mean distance from the centre: 2/3 r of a disc; (sqrt(2) + asinh(1)) / 3 of half its side of a square.
  FlatByHand hand;
  hand.box(0, 0, 0.2, 0.2, 0.7);
  hand.cylinder(0, 1, 0.1, 0.4);
  hand.object_motion(0).w_rad_s = {0, 0, 9.0};
  hand.object_motion(1).w_rad_s = {0, 0, 9.0};
  hand.tick();
  const double square = 1.49 * 0.1 * (std::sqrt(2.0) + std::asinh(1.0)) / 3 / (0.08 / 12);
  const double disc = 1.49 * 0.1 * 2 / 3 / 0.005;
  EXPECT_NEAR(hand.object_motion(0).w_rad_s[2], left_of(9.0, square, 1), 1e-3);
  EXPECT_NEAR(hand.object_motion(1).w_rad_s[2], left_of(9.0, disc, 1), 1e-3);
}

TEST(Dynamics2dGround, CollidingObjectsKeepTheirMomentumAndGainNoEnergy) {
  FlatByHand hand({{"box_linear_friction", "0", 0},
                   {"box_angular_friction", "0", 0},
                   {"cylinder_linear_friction", "0", 0},
                   {"cylinder_angular_friction", "0", 0}});
  hand.box(0, 0, 0.1, 0.1, 0.5, 0.3);
  hand.box(0.4, 0.05, 0.1, 0.1, 0.2);
  hand.cylinder(0.2, 0.3, 0.06, 0.3);
  hand.object_motion(0).v_m_s = {0.2, 0.02, 0};
  hand.object_motion(1).v_m_s = {-0.1, 0, 0};
  hand.object_motion(2).v_m_s = {0, -0.15, 0};
  const auto momentum = [&](std::size_t axis) {
    double sum = 0.0;
    for (std::size_t i = 0; i < 3; ++i) sum += hand.object(i).mass_kg * hand.object_motion(i).v_m_s[axis];
    return sum;
  };
  const auto energy = [&] {
    double sum = 0.0;
    for (std::size_t i = 0; i < 3; ++i) {
      const Object& o = hand.object(i);
      const Motion& m = hand.object_motion(i);
      const double inertia = o.kind == Object::Kind::Cylinder
                                 ? 0.5 * o.mass_kg * o.radius_m * o.radius_m
                                 : o.mass_kg / 3 * (o.half_x_m * o.half_x_m + o.half_y_m * o.half_y_m);
      sum += 0.5 * o.mass_kg * (m.v_m_s[0] * m.v_m_s[0] + m.v_m_s[1] * m.v_m_s[1]) +
             0.5 * inertia * m.w_rad_s[2] * m.w_rad_s[2];
    }
    return sum;
  };
  const double px = momentum(0);
  const double py = momentum(1);
  double last = energy();
  const double first = last;
  for (int i = 0; i < 80; ++i) {
    hand.tick();
    EXPECT_NEAR(momentum(0), px, 1e-6) << i;
    EXPECT_NEAR(momentum(1), py, 1e-6) << i;
    EXPECT_LE(energy(), last + 1e-8) << i;
    last = energy();
  }
  EXPECT_LT(last, 0.9 * first);  // they did collide
}

TEST(Dynamics2dGround, WallsOfTheRegionHoldRobotsAndObjectsAndOpenSidesLetThemPass) {
  FlatByHand hand;
  hand.region({{-1, -1, true}, {1, -1, true}, {1, 1, false}, {-1, 1, true}});  // open to the north
  hand.robot(0.8, 0, 0, 0.1, 0.1);
  hand.robot(0, 0.8, 0.5 * M_PI, 0.1, 0.1);
  hand.robot(-0.8, -0.2, -M_PI, 0.1, 0.1);
  hand.box(-0.3, -0.8, 0.1, 0.1, 0.2);
  hand.robot(-0.3, -0.7, -0.5 * M_PI, 0.1, 0.1);
  hand.ticks(60);
  EXPECT_NEAR(hand.bodies().x_m[0], 1 - kRadius_m, 1e-3);
  EXPECT_NEAR(hand.bodies().x_m[2], -1 + kRadius_m, 1e-3);
  EXPECT_NEAR(hand.bodies().y_m[1], 1.4, 1e-3);
  EXPECT_NEAR(hand.object().y_m, -0.95, 2e-3);
}

TEST(Dynamics2dGround, ImmovableObjectsAppearAndGoWithTheirVersion) {
  FlatByHand hand;
  hand.robot(0, 0, 0, 0.1, 0.1);
  hand.box(0.5, 0, 0.2, 0.5, 0.0);
  hand.ticks(60);
  EXPECT_NEAR(hand.bodies().x_m[0], 0.4 - kRadius_m, 1e-3);
  hand.object().alive = false;
  ++hand.stores().immovables_version;
  hand.ticks(60);
  EXPECT_NEAR(hand.bodies().x_m[0], 0.4 - kRadius_m + 0.6, 2e-3);
  hand.box(1.2, 0, 0.2, 0.5, 0.0);
  hand.ticks(60);
  EXPECT_NEAR(hand.bodies().x_m[0], 1.1 - kRadius_m, 1e-3);
}

TEST(Dynamics2dGround, AFastObjectIsNotCarriedThroughAThinWall) {
  for (const double speed_m_s : {0.5, 1.5, 5.0, 20.0}) {
    FlatByHand hand({{"box_linear_friction", "0", 0}});
    hand.box(0, 0, 0.1, 0.1, 0.2);
    hand.box(1.0, 0, 0.01, 2.0, 0.0);
    hand.object_motion().v_m_s = {speed_m_s, 0, 0};
    hand.ticks(30);
    EXPECT_LE(hand.object().x_m, 0.945 + 1.5e-3) << speed_m_s;
    EXPECT_GE(hand.object().x_m, 0.9) << speed_m_s;
    EXPECT_TRUE(hand.trouble.empty()) << hand.trouble[0].what;
  }
}

TEST(Dynamics2dGround, TinyAndHugeMasses) {
  FlatByHand hand;
  hand.box(0, 0, 1e-4, 1e-4, 1e-6);
  hand.box(1, 0, 3.0, 0.001, 0.001, 1.57);
  hand.cylinder(-3, 0, 2.0, 1e4);
  hand.object_motion(0).v_m_s = {0.01, 0, 0};
  hand.object_motion(2).v_m_s = {0.5, 0, 0};
  hand.ticks(30);
  EXPECT_TRUE(hand.trouble.empty()) << hand.trouble[0].what;
  EXPECT_NEAR(hand.object_motion(0).v_m_s[0], 0.0, 1e-6);
  EXPECT_NEAR(hand.object_motion(2).v_m_s[0], 0.0, 1e-5);
  EXPECT_GT(hand.object(2).x_m, -3.0 + 0.05);
}

}  // namespace
}  // namespace tandem::core
