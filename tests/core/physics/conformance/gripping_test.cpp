// What engines with forces promise of two bodies that are held together.
#include "tests/core/physics/conformance/engines.hpp"

namespace tandem::core {
namespace {

class Gripping : public EveryEngine {
 protected:
  double hold_m() const { return 2 * depth_m(); }  // by which the two may come apart while they move
};

/// Where a joint's point is, as each of its two bodies has it.
struct Ends {
  double ax_m, ay_m, bx_m, by_m;
  double apart_m() const { return std::hypot(ax_m - bx_m, ay_m - by_m); }
};

struct Frame {
  double x_m, y_m, cos_h, sin_h;
};

Frame frame_of(const SpaceStores& s, BodyKey body) {
  const std::size_t i = body.index();
  if (body.is_object()) return {s.objects[i].x_m, s.objects[i].y_m, s.objects[i].cos_h, s.objects[i].sin_h};
  return {s.bodies.x_m[i], s.bodies.y_m[i], s.bodies.cos_h[i], s.bodies.sin_h[i]};
}

Ends ends_of(const MadeWorld& world, std::size_t i = 0) {
  const SpaceStores& s = world.world->space().stores();
  const Joint& j = s.joints[i];
  const Frame a = frame_of(s, j.a);
  const Frame b = frame_of(s, j.b);
  return {a.x_m + a.cos_h * j.ax_m - a.sin_h * j.ay_m, a.y_m + a.sin_h * j.ax_m + a.cos_h * j.ay_m,
          b.x_m + b.cos_h * j.bx_m - b.sin_h * j.by_m, b.y_m + b.sin_h * j.bx_m + b.cos_h * j.by_m};
}

BodyKey robot_key(const MadeWorld& world, const std::string& id) {
  const Space& space = world.world->space();
  return BodyKey::robot(space.stores().row_of(space.find_robot(id)));
}

/// Holds `a` and `b` together where they are, at the point (x, y).
void hold(const MadeWorld& world, BodyKey a, BodyKey b, double x_m, double y_m, bool turns = false) {
  SpaceStores& s = world.world->space().stores();
  Joint joint;
  joint.alive = true;
  joint.generation = static_cast<std::uint32_t>(s.joints.size()) + 1;
  joint.a = a;
  joint.b = b;
  const auto into = [&](const Frame& f, double& fx, double& fy) {
    fx = f.cos_h * (x_m - f.x_m) + f.sin_h * (y_m - f.y_m);
    fy = f.cos_h * (y_m - f.y_m) - f.sin_h * (x_m - f.x_m);
  };
  const Frame at_a = frame_of(s, a);
  const Frame at_b = frame_of(s, b);
  into(at_a, joint.ax_m, joint.ay_m);
  into(at_b, joint.bx_m, joint.by_m);
  joint.az_m = joint.bz_m = 0.03;
  joint.form.kind = turns ? JointKind::Turning : JointKind::Fixed;
  joint.heading_rad =
      std::atan2(at_b.sin_h * at_a.cos_h - at_b.cos_h * at_a.sin_h, at_b.cos_h * at_a.cos_h + at_b.sin_h * at_a.sin_h);
  s.joints.push_back(joint);
}

/// A robot at (x, 0) that faces a box to its east, which it will hold at their common rim.
Scene puller(const Scene& empty, double x_m, double left_m_s, double right_m_s, double mass_kg = 0.1) {
  Scene s = empty;
  s.robot("a", x_m, 0).wheels(left_m_s, right_m_s);
  return s.box(x_m + kRobotRadius_m + 0.0501, 0, 0.1, 0.1, 0.0, 0.06).movable(mass_kg);
}

TEST_P(Gripping, ARobotPullsWhatItHoldsAndLetsItGo) {
  for (const bool turns : {false, true}) {
    auto world = make(puller(scene(), 0.5, -0.1, -0.1));
    ASSERT_TRUE(world.world) << world.all_problems();
    hold(world, robot_key(world, "a"), BodyKey::object(0), 0.5 + kRobotRadius_m, 0.0, turns);
    const std::vector<Object>& objects = world->space().objects();
    steps(world, 20);
    const double robot_m = pose_of(world, "a").x_m;
    const double box_m = objects[0].x_m;
    for (int i = 0; i < 50; ++i) {
      world->step();
      ASSERT_LE(ends_of(world).apart_m(), hold_m()) << i;
    }
    EXPECT_NEAR(pose_of(world, "a").x_m - robot_m, -0.5, 0.02 * 0.5);
    EXPECT_NEAR(objects[0].x_m - box_m, -0.5, 0.02 * 0.5);
    world->space().stores().joints[0].alive = false;
    const double released_m = objects[0].x_m;
    steps(world, 30);
    EXPECT_NEAR(pose_of(world, "a").x_m - robot_m, -0.8, 0.02 * 0.8);  // drives on
    EXPECT_NEAR(objects[0].x_m, released_m, 0.02);                     // stays, but for a little glide
    EXPECT_EQ(world->state(), RunState::Running) << world->failure();
  }
}

TEST_P(Gripping, AHeldBoxTurnsWithTheRobotUnlessItMayTurn) {
  auto world = make(puller(scene(), 0.0, -0.03, 0.03, 0.02));
  ASSERT_TRUE(world.world) << world.all_problems();
  hold(world, robot_key(world, "a"), BodyKey::object(0), kRobotRadius_m, 0.0);
  double turn_rad = 0.0;
  double last_rad = 0.0;
  for (int i = 0; i < 30; ++i) {
    world->step();
    const Pose robot = pose_of(world, "a");
    turn_rad += turned_rad(last_rad, robot.heading_rad());
    last_rad = robot.heading_rad();
    const Object& box = world->space().objects()[0];
    ASSERT_LE(ends_of(world).apart_m(), hold_m()) << i;
    ASSERT_NEAR(turned_rad(robot.heading_rad(), std::atan2(box.sin_h, box.cos_h)), 0.0, 0.1) << i;
  }
  EXPECT_GT(turn_rad, 1.0);
}

TEST_P(Gripping, TheDrivesTorqueIsLimited) {
  // To swing the box round itself, the robot would need about 0.8 kg x 1.5 N/kg x 8.5 cm = 0.1 N m; it has 0.04.
  auto world = make(puller(scene(), 0.0, -0.03, 0.03, 0.8));
  ASSERT_TRUE(world.world) << world.all_problems();
  hold(world, robot_key(world, "a"), BodyKey::object(0), kRobotRadius_m, 0.0);
  steps(world, 60);
  EXPECT_NEAR(pose_of(world, "a").heading_rad(), 0.0, 0.1);
  EXPECT_NEAR(world->space().objects()[0].y_m, 0.0, 5e-3);
}

TEST_P(Gripping, WhatARobotHoldsCrossesBordersWithIt) {
  Scene empty = scene();
  empty.split("4x1");  // borders at x = -1, 0, 1
  auto world = make(puller(empty, 0.3, -0.1, -0.1));
  ASSERT_TRUE(world.world) << world.all_problems();
  hold(world, robot_key(world, "a"), BodyKey::object(0), 0.3 + kRobotRadius_m, 0.0);
  const SpaceStores& s = world->space().stores();
  steps(world, 5);
  for (int i = 0; i < 150; ++i) {
    const double robot_m = pose_of(world, "a").x_m;
    const double box_m = s.objects[0].x_m;
    world->step();
    ASSERT_EQ(world->state(), RunState::Running) << world->failure();
    ASSERT_EQ(s.bodies.region[robot_key(world, "a").index()], s.object_region[0]) << "box at " << box_m;
    ASSERT_LE(ends_of(world).apart_m(), hold_m()) << "box at " << box_m;
    EXPECT_NEAR(pose_of(world, "a").x_m - robot_m, -0.01, 5e-4) << "robot at " << robot_m;
    EXPECT_NEAR(s.objects[0].x_m - box_m, -0.01, 5e-4) << "box at " << box_m;
  }
  EXPECT_LT(s.objects[0].x_m, -1.0);
}

TEST_P(Gripping, TwoRobotsInARowDriveAsOne) {
  auto world = make(scene().robot("a", 0, 0).wheels(0.1, 0.1).robot("b", -2.2 * kRobotRadius_m, 0).wheels(0.06, 0.06));
  ASSERT_TRUE(world.world) << world.all_problems();
  hold(world, robot_key(world, "a"), robot_key(world, "b"), -kRobotRadius_m, 0.0);
  steps(world, 20);
  const double a_m = pose_of(world, "a").x_m;
  const double b_m = pose_of(world, "b").x_m;
  for (int i = 0; i < 50; ++i) {
    world->step();
    ASSERT_LE(ends_of(world).apart_m(), hold_m()) << i;
  }
  // Neither is faster than its own wheels' rim speed lets the pair be.
  EXPECT_NEAR(pose_of(world, "a").x_m - a_m, pose_of(world, "b").x_m - b_m, 2 * hold_m());
  EXPECT_GE(pose_of(world, "a").x_m - a_m, 0.98 * 0.3);
  EXPECT_LE(pose_of(world, "a").x_m - a_m, 1.02 * 0.5);
}

TEST_P(Gripping, AHeldThingThatIsTooHeavyHoldsTheRobot) {
  auto world = make(puller(scene(), 0.0, -0.1, -0.1, 20.0));
  ASSERT_TRUE(world.world) << world.all_problems();
  hold(world, robot_key(world, "a"), BodyKey::object(0), kRobotRadius_m, 0.0);
  steps(world, 60);
  EXPECT_NEAR(world->space().objects()[0].x_m, kRobotRadius_m + 0.0501, 2e-3);
  EXPECT_NEAR(pose_of(world, "a").x_m, 0.0, 2e-3 + hold_m());
  EXPECT_EQ(world->state(), RunState::Running) << world->failure();
}

TEST_P(Gripping, AHolderThatIsRemovedSetsTheThingFree) {
  auto world = make(puller(scene(), 0.5, -0.1, -0.1).robot("other", -1, 1).wheels(0, 0));
  ASSERT_TRUE(world.world) << world.all_problems();
  hold(world, robot_key(world, "a"), BodyKey::object(0), 0.5 + kRobotRadius_m, 0.0);
  steps(world, 20);
  world->space().remove_robot(world->space().find_robot("a"));
  const double released_m = world->space().objects()[0].x_m;
  steps(world, 30);
  EXPECT_EQ(world->state(), RunState::Running) << world->failure();
  EXPECT_NEAR(world->space().objects()[0].x_m, released_m, 0.02);
}

INSTANTIATE_TEST_SUITE_P(Physics, Gripping, testing::ValuesIn(kinds_with_forces()), name_of_kind);

}  // namespace
}  // namespace tandem::core
