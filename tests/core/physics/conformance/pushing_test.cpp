// What engines with forces promise of movable objects: how they glide, how robots push them, what stays put.
#include "core/space/object_index.hpp"
#include "tests/core/physics/conformance/engines.hpp"

namespace tandem::core {
namespace {

/// How the ground holds a movable object in a kind of engine: with at most this force per kilogram, in N/kg.
double grip_m_s2(const std::string& kind) {
  if (kind == "dynamics2d") return 1.49;  // ARGoS' default, box_linear_friction and cylinder_linear_friction
  if (kind == "dynamics3d") return 0.2 * 9.81;
  ADD_FAILURE() << "say here how the ground brakes objects in " << kind;
  return 0.0;
}

class Pushing : public EveryEngine {
 protected:
  /// An arena with a ground that grips as `grip_m_s2` says.
  Scene ground(double size_m = 4.0) const {
    Scene s(size_m);
    if (GetParam() == "dynamics3d")
      s.engine("dynamics3d", "", {{"default_friction", "0.2", 0}});
    else
      s.engine(GetParam());
    return s;
  }
  double grip() const { return grip_m_s2(GetParam()); }
};

const Object& object(const MadeWorld& world, std::size_t i = 0) {
  return world.world->space().objects()[i];
}

/// Sets a movable object in motion, as a hook may.
void shove(const MadeWorld& world, std::size_t i, double vx_m_s, double vy_m_s) {
  world.world->space().stores().object_motion[i].v_m_s = {vx_m_s, vy_m_s, 0.0};
}

double speed_of(const MadeWorld& world, std::size_t i) {
  const Motion& m = world.world->space().stores().object_motion[i];
  return std::hypot(m.v_m_s[0], m.v_m_s[1]);
}

TEST_P(Pushing, AnObjectThatGlidesIsBrakedByTheGroundAlone) {
  // v^2 / (2 g) [Coulomb], less at most half a tick's way where an engine brakes before it moves.
  for (const double speed_m_s : {0.1, 0.5}) {
    for (const bool round : {false, true}) {
      Scene s = ground().robot("far", -1.5, 1.5).wheels(0, 0);
      if (round)
        s.cylinder(0, 0, 0.08).movable(0.4);
      else
        s.box(0, 0, 0.16, 0.16, 0.0, 0.1).movable(0.4);
      if (round) s.scenario.objects.back().size[2] = 0.05;
      auto world = make(s);
      ASSERT_TRUE(world.world) << world.all_problems();
      steps(world, 5);
      EXPECT_NEAR(object(world).x_m, 0.0, 1e-4);
      const double from_m = object(world).x_m;
      shove(world, 0, speed_m_s, 0.0);
      double last_m_s = speed_m_s;
      for (int i = 0; i < 60; ++i) {
        world->step();
        ASSERT_LE(speed_of(world, 0), last_m_s + 1e-6) << "faster in tick " << i;
        last_m_s = speed_of(world, 0);
      }
      const double way_m = speed_m_s * speed_m_s / (2 * grip());
      EXPECT_LE(object(world).x_m - from_m, 1.05 * way_m + 1e-4) << speed_m_s << (round ? " round" : " box");
      EXPECT_GE(object(world).x_m - from_m, 0.95 * way_m - 0.5 * 0.1 * speed_m_s - 1e-4)
          << speed_m_s << (round ? " round" : " box");
      EXPECT_NEAR(object(world).y_m, 0.0, 1e-3);
      EXPECT_NEAR(last_m_s, 0.0, 1e-4);
    }
  }
}

TEST_P(Pushing, ARobotPushesALightBoxAtItsOwnSpeed) {
  for (const int per_second : {10, 20, 50}) {
    for (const double mass_kg : {0.05, 0.2, 0.4}) {  // held with 0.8 N at most; the drive has 1.5
      Scene s = ground().box(0, 0, 0.1, 0.3, 0.0, 0.06).movable(mass_kg).robot("a", -0.15, 0).wheels(0.1, 0.1);
      s.scenario.ticks_per_second = per_second;
      auto world = make(s);
      ASSERT_TRUE(world.world) << world.all_problems();
      const std::string what = std::to_string(mass_kg) + " kg, " + std::to_string(per_second) + " ticks a second";
      steps(world, 4 * per_second);
      const double box_m = object(world).x_m;
      const double robot_m = pose_of(world, "a").x_m;
      steps(world, 5 * per_second);
      EXPECT_NEAR(object(world).x_m - box_m, 0.5, 0.02 * 0.5) << what;
      EXPECT_NEAR(pose_of(world, "a").x_m - robot_m, 0.5, 0.02 * 0.5) << what;
      EXPECT_NEAR(object(world).x_m - 0.05 - kRobotRadius_m, pose_of(world, "a").x_m, depth_m()) << what;
      EXPECT_NEAR(object(world).y_m, 0.0, 5e-3) << what;
      // Released, it glides no farther than its friction lets it.
      set_halted(world, "a");
      steps(world, 1);
      const double released_m = object(world).x_m;
      steps(world, 2 * per_second);
      EXPECT_LE(object(world).x_m - released_m, 0.1 * 0.1 / (2 * grip()) + 1e-3) << what;
      EXPECT_GE(object(world).x_m, released_m - 1e-4) << what;
    }
  }
}

TEST_P(Pushing, ABoxTooHeavyForTheDriveStays) {
  // Held with twice what the drive has.
  const double mass_kg = 2 * hal::epuck::kind().drive()->force_N / grip();
  auto world =
      make(ground().box(0, 0, 0.1, 0.3, 0.0, 0.06).movable(mass_kg).robot("a", -0.2, 0).wheels(0.1288, 0.1288));
  ASSERT_TRUE(world.world) << world.all_problems();
  steps(world, 200);
  EXPECT_NEAR(object(world).x_m, 0.0, 1e-3);
  EXPECT_NEAR(object(world).y_m, 0.0, 1e-3);
  EXPECT_LE(pose_of(world, "a").x_m, -0.05 - kRobotRadius_m + depth_m());
  EXPECT_GT(pose_of(world, "a").x_m, -0.05 - kRobotRadius_m - 2 * depth_m());
}

/// One file, one friction: with an engine's own settings a robot moves what the ground grips with less than the force
/// of its drive, 1.49 N a kg, and nothing heavier.
TEST_P(Pushing, WhatARobotCanPushIsTheSameInEveryEngine) {
  const double most_kg = hal::epuck::kind().drive()->force_N / 1.49;
  const bool turning_wheels = GetParam() == "dynamics3d";
  for (const bool wheels : {false, true}) {
    if (wheels && !turning_wheels) continue;
    for (const double part : {0.93, 1.07}) {
      Scene s(4.0);
      s.engine(GetParam(), "",
               wheels ? std::vector<Element::Attribute>{{"drive", "wheels", 1}} : std::vector<Element::Attribute>{});
      s.box(0, 0, 0.1, 0.3, 0.0, 0.02).movable(part * most_kg).robot("a", -0.1, 0).wheels(0.1, 0.1);
      s.scenario.ticks_per_second = 50;
      s.parts([](hal::RobotKind& kind) { kind.body.mass_kg = 1.6; });  // heavy enough that its wheels do not slip
      auto world = make(s);
      ASSERT_TRUE(world.world) << world.all_problems();
      steps(world, 300);  // long after the first impact
      const double from_m = object(world).x_m;
      steps(world, 100);
      if (part < 1.0)
        EXPECT_NEAR(object(world).x_m - from_m, 0.2, 0.01) << part << (wheels ? " on wheels" : "");
      else
        EXPECT_LT(object(world).x_m - from_m, 1e-3) << part << (wheels ? " on wheels" : "");
    }
  }
}

TEST_P(Pushing, TwoRobotsMoveWhatOneCannot) {
  const double mass_kg = 1.4 * hal::epuck::kind().drive()->force_N / grip();
  for (const bool both : {false, true}) {
    Scene s = ground().box(0, 0, 0.1, 0.3, 0.0, 0.06).movable(mass_kg);
    s.robot("a", -0.12, both ? 0.06 : 0.0).wheels(0.1, 0.1);
    if (both) s.robot("b", -0.12, -0.06).wheels(0.1, 0.1);
    auto world = make(s);
    ASSERT_TRUE(world.world) << world.all_problems();
    steps(world, 80);
    if (both)
      EXPECT_GT(object(world).x_m, 0.3);
    else
      EXPECT_LT(object(world).x_m, 2e-3);
  }
}

TEST_P(Pushing, ABoxAgainstAWallStopsTheRobotThatPushesIt) {
  auto world = make(
      ground().box(0.5, 0, 0.2, 1.0).box(0.25, 0, 0.1, 0.2, 0.0, 0.06).movable(0.2).robot("a", 0, 0).wheels(0.1, 0.1));
  ASSERT_TRUE(world.world) << world.all_problems();
  steps(world, 150);
  EXPECT_LE(object(world, 1).x_m, 0.35 + depth_m());
  EXPECT_GE(object(world, 1).x_m, 0.35 - 2 * depth_m());
  EXPECT_LE(pose_of(world, "a").x_m, 0.3 - kRobotRadius_m + 2 * depth_m());
  EXPECT_EQ(world->state(), RunState::Running) << world->failure();
}

TEST_P(Pushing, PushedAsideABoxTurns) {
  // Pushed at its left end while it drives to the east, a box turns clockwise.
  // Light enough that its drive (1.5 N at 0.1 m) overcomes the ground's torque under either law of friction.
  auto world = make(ground().box(0, 0, 0.06, 0.3, 0.0, 0.06).movable(0.03).robot("a", -0.1, 0.1).wheels(0.1, 0.1));
  ASSERT_TRUE(world.world) << world.all_problems();
  steps(world, 40);
  const double heading_rad = std::atan2(object(world).sin_h, object(world).cos_h);
  EXPECT_LT(heading_rad, -0.1);
  EXPECT_NEAR(std::hypot(object(world).cos_h, object(world).sin_h), 1.0, 1e-6);
}

TEST_P(Pushing, CollidingObjectsGainNoEnergyAndKeepTheirMomentumButForFriction) {
  Scene s = ground();
  s.cylinder(0, 0, 0.06)
      .movable(0.3)
      .cylinder(0.4, 0.01, 0.06)
      .movable(0.5)
      .box(0.2, 0.5, 0.1, 0.1, 0.3, 0.06)
      .movable(0.2);
  for (ObjectItem& item : s.scenario.objects) item.size[2] = 0.05;
  auto world = make(s);
  ASSERT_TRUE(world.world) << world.all_problems();
  steps(world, 5);
  const double masses_kg[3] = {0.3, 0.5, 0.2};
  shove(world, 0, 1.2, 0.0);
  shove(world, 2, 0.1, -0.6);
  const auto energy_J = [&] {
    double sum = 0.0;
    for (std::size_t i = 0; i < 3; ++i) sum += 0.5 * masses_kg[i] * speed_of(world, i) * speed_of(world, i);
    return sum;
  };
  double last_J = energy_J();
  double momentum = 0.3 * 1.2 + 0.2 * 0.1;
  for (int i = 0; i < 40; ++i) {
    world->step();
    ASSERT_LE(energy_J(), last_J + 1e-6) << "in tick " << i;
    last_J = energy_J();
    double now = 0.0;
    for (std::size_t k = 0; k < 3; ++k) now += masses_kg[k] * world->space().stores().object_motion[k].v_m_s[0];
    ASSERT_LE(now, momentum + 1e-6) << "in tick " << i;
    // The ground takes at most its grip on all three.
    ASSERT_GE(now, momentum - 1.05 * 0.1 * grip() * 1.0 - 1e-6) << "in tick " << i;
    momentum = now;
  }
  EXPECT_NEAR(last_J, 0.0, 1e-6);
  // It was hit, after a gap of 0.28 m, and took part of the other's momentum at least as in a collision without bounce.
  const double hit_m_s = std::sqrt(1.2 * 1.2 - 2 * grip() * 0.28);
  const double after_m_s = 0.3 / (0.3 + 0.5) * hit_m_s;
  EXPECT_GT(object(world, 1).x_m, 0.4 + 0.5 * after_m_s * after_m_s / (2 * grip()));
}

TEST_P(Pushing, ARobotMovedByOthersPushesABox) {
  auto world = make(ground().box(0, 0, 0.1, 0.2, 0.0, 0.06).movable(0.3).robot("real", -0.2, 0));
  ASSERT_TRUE(world.world) << world.all_problems();
  Space& space = world->space();
  const RobotId real = space.find_robot("real");
  space.set_external(real, true);
  double x_m = -0.2;
  for (int i = 0; i < 60; ++i) {
    x_m += 0.01;
    space.set_pose(real, {x_m, 0.0, 0.0, 1.0, 0.0});
    world->step();
    ASSERT_EQ(space.pose(real).x_m, x_m);
    ASSERT_GE(object(world).x_m - 0.05 - kRobotRadius_m, x_m - 0.01 - depth_m()) << i;  // a tick's way at most
  }
  EXPECT_GT(object(world).x_m, 0.4);
  EXPECT_LT(object(world).x_m, x_m + 0.05 + kRobotRadius_m + 0.1 * 0.1 / (2 * grip()) + 2e-3);
}

TEST_P(Pushing, TheGroundIsLevel) {
  Scene s = ground().box(0.5, 0, 0.2, 0.2, 0.4, 0.1).movable(0.3).cylinder(-0.5, 0, 0.1).movable(0.3);
  s.robot("a", 0, 1).wheels(0, 0);
  auto world = make(s);
  ASSERT_TRUE(world.world) << world.all_problems();
  steps(world, 200);
  EXPECT_NEAR(object(world, 0).x_m, 0.5, 1e-3);
  EXPECT_NEAR(object(world, 0).y_m, 0.0, 1e-3);
  EXPECT_NEAR(std::atan2(object(world, 0).sin_h, object(world, 0).cos_h), 0.4, 1e-2);
  EXPECT_NEAR(object(world, 1).x_m, -0.5, 1e-3);
  EXPECT_NEAR(object(world, 1).y_m, 0.0, 1e-3);
  EXPECT_NEAR(object(world, 1).z_low_m, 0.0, depth_m());
}

TEST_P(Pushing, AnObjectThatLeavesTheArenaIsNamed) {
  for (const EscapePolicy policy : {EscapePolicy::Error, EscapePolicy::Stop, EscapePolicy::Remove}) {
    Scene s = ground(1.0).box(0.3, 0, 0.1, 0.1, 0.0, 0.06).movable(0.3).robot("a", -0.3, 0).wheels(0, 0);
    s.scenario.escape = policy;
    auto world = make(s);
    ASSERT_TRUE(world.world) << world.all_problems();
    steps(world, 2);
    shove(world, 0, 1.5, 0.0);
    steps(world, 20);
    EXPECT_GE(world->incidents().bodies_escaped, 1U);
    if (policy == EscapePolicy::Error) {
      EXPECT_EQ(world->state(), RunState::Failed);
      EXPECT_NE(world->failure().find("box 'box0' left the arena"), std::string::npos) << world->failure();
      continue;
    }
    EXPECT_EQ(world->state(), RunState::Running) << world->failure();
    ASSERT_FALSE(world->incidents().first().empty());
    EXPECT_NE(world->incidents().first()[0].find("box 'box0' left the arena"), std::string::npos);
    EXPECT_EQ(object(world).alive, policy == EscapePolicy::Stop);
    if (policy == EscapePolicy::Stop) {
      EXPECT_NEAR(object(world).x_m, 0.5, 1e-6);
      EXPECT_NEAR(speed_of(world, 0), 0.0, 1e-9);
    }
  }
}

TEST_P(Pushing, AnObjectWhosePlaceOrSpeedIsNoNumberEndsTheRunByName) {
  for (const bool place : {true, false}) {
    auto world = make(ground().box(0, 0, 0.1, 0.1, 0.0, 0.06).movable(0.3).robot("a", 1, 1).wheels(0, 0));
    ASSERT_TRUE(world.world) << world.all_problems();
    steps(world, 2);
    if (place)
      world->space().stores().objects[0].x_m = std::nan("");
    else
      world->space().stores().object_motion[0].v_m_s[1] = std::nan("");
    world->step();
    EXPECT_EQ(world->state(), RunState::Failed) << (place ? "place" : "speed");
    EXPECT_NE(world->failure().find("box 'box0'"), std::string::npos) << world->failure();
    EXPECT_NE(world->failure().find("tick 2"), std::string::npos) << world->failure();
  }
}

/// How deep a robot's rim is in an object, in m; negative: the gap between them.
double depth_in(const Object& o, const Pose& robot) {
  double nx = 0.0;
  double ny = 0.0;
  return kRobotRadius_m - signed_distance(o, robot.x_m, robot.y_m, nx, ny);
}

/// Speed at which two bodies that close in at `closing_m_s` each can squeeze a third out from between them, where rims
/// rub with `friction`. Its sides must lean by more than the angle of friction, of which the tangent is `friction`: it
/// then leaves at closing / tan(lean), as a stone between two wet fingers.
double squeezed_out_m_s(double closing_m_s, double friction) {
  return closing_m_s / friction;
}

void expect_no_harm_in_a_crowd_among_things(const std::string& kind, const char* split, std::uint64_t seed) {
  SCOPED_TRACE(std::string(split) + ", seed " + std::to_string(seed));
  constexpr int kThings = 12;
  constexpr double kRim_m_s = 0.1;  // of the faster wheel
  const double most_m_s = kRim_m_s + squeezed_out_m_s(kRim_m_s, 0.1);
  Scene s(2.0);  // blind robots in circles of 33 cm radius
  s.scenario.seed = seed;
  s.engine(kind).split(split).param("left", "0.1").param("right", "0.085").walls().robots(60, 0.85);
  for (int i = 0; i < kThings; ++i) {
    const double x_m = 0.5 * (i % 4 - 1.5);
    const double y_m = 0.6 * (i / 4 - 1.0);
    if (i % 2 == 0)
      s.box(x_m, y_m, 0.08, 0.12, 0.5 * i, 0.05).movable(0.05 + 0.02 * i);
    else
      s.cylinder(x_m, y_m, 0.05).movable(0.05 + 0.02 * i);
  }
  auto world = make(s);
  ASSERT_TRUE(world.world) << world.all_problems();
  const Space& space = world->space();
  double moved_m = 0.0;
  double deepest_m = 0.0;
  double overlap = 0.0;
  int at_wall = 0;
  int deep_in_wall = 0;
  const std::vector<Object> before = space.objects();
  for (int tick = 0; tick < 300; ++tick) {
    world->step();
    ASSERT_EQ(world->state(), RunState::Running) << world->failure();
    overlap = std::max(overlap, crowd_of(space, 0.0).deepest_m / (2.0 * kRobotRadius_m));
    for (std::size_t i = 0; i < space.objects().size(); ++i) {
      const Object& o = space.objects()[i];
      if (!o.movable) continue;
      // The thinnest is 4 cm to a side; squeezed by many, it goes into a wall by two ticks' way at most.
      ASSERT_LT(std::max(std::fabs(o.x_m), std::fabs(o.y_m)), 0.9 - 0.04 + 0.02) << o.id << " in tick " << tick;
      ASSERT_LT(speed_of(world, i), most_m_s) << o.id << " in tick " << tick;
      moved_m = std::max(moved_m, std::hypot(o.x_m - before[i].x_m, o.y_m - before[i].y_m));
      for (std::size_t r = 0; r < space.robot_count(); ++r)
        deepest_m = std::max(deepest_m, depth_in(o, space.pose(space.robot(r))));
    }
    for (std::size_t r = 0; r < space.robot_count(); ++r) {
      const Pose pose = space.pose(space.robot(r));
      const double deep_m = std::max(std::fabs(pose.x_m), std::fabs(pose.y_m)) - (0.9 - kRobotRadius_m);
      ASSERT_LT(deep_m, 0.01 + depth_bar_m(kind)) << "in tick " << tick;  // squeezed by others: a tick's way at most
      if (deep_m > -1e-3) ++at_wall;
      if (deep_m > depth_bar_m(kind)) ++deep_in_wall;
    }
  }
  EXPECT_EQ(space.robot_count(), 60U);
  EXPECT_GT(moved_m, 0.1);     // somebody pushed something
  EXPECT_LT(deepest_m, 0.02);  // a tick's way of both sides
  EXPECT_GT(at_wall, 500);
  EXPECT_LT(deep_in_wall, 0.1 * at_wall);
  EXPECT_LE(overlap, 0.02);
  EXPECT_NEAR(world->accuracy().overlap, overlap, 0.003);
}

TEST_P(Pushing, ACrowdAmongThingsToPushStaysWithinItsWallsAndComesToNoHarm) {
  const std::uint64_t seeds = GetParam() == "dynamics3d" ? 1 : 8;  // of which most go wrong with sub-steps of 0.1 s
  for (std::uint64_t seed = 7; seed < 7 + seeds; ++seed) {
    for (const char* split : {"1x1", "2x2"}) expect_no_harm_in_a_crowd_among_things(GetParam(), split, seed);
  }
}

INSTANTIATE_TEST_SUITE_P(Physics, Pushing, testing::ValuesIn(kinds_with_forces()), name_of_kind);

}  // namespace
}  // namespace tandem::core
