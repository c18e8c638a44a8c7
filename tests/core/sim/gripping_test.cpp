// Grippers and loaded turrets, with both engines that know forces.
#include <cmath>
#include <gmock/gmock.h>
#include <numbers>

#include "core/space/mechanisms.hpp"
#include "hal/angle.hpp"
#include "hal/device/gripper.hpp"
#include "tests/core/footbots.hpp"

namespace tandem::core {
namespace {

using hal::Gripper;
using hal::GripperDrive;
using hal::TurretDrive;
using hal::TurretEncoder;
using hal::WheelSpeeds;
using testing::HasSubstr;

const double kR = hal::footbot::kind().body.radius_m;
constexpr double kPi = std::numbers::pi;

class Gripping : public testing::TestWithParam<const char*> {
 protected:
  Scene scene(double size_m = 4.0) { return footbot_scene(GetParam(), size_m); }
};
INSTANTIATE_TEST_SUITE_P(Engines, Gripping, testing::Values("dynamics2d", "dynamics3d"),
                         [](const auto& engine) { return std::string(engine.param); });

MadeWorld made(const Scene& scene, const WorldOptions& options = {}) {
  auto world = make(scene, options);
  EXPECT_TRUE(world.world) << world.all_problems();
  if (world.world) {
    world->start();
    world->step();
  }
  return world;
}

const Object& thing(const MadeWorld& world, std::size_t i = 0) {
  return world.world->space().objects()[i];
}

/// A robot at the middle that looks at a cylinder of 0.1 m radius, `gap_m` before its rim.
Scene with_cylinder(Scene scene, double gap_m = 0.01, double mass_kg = 0.2) {
  add_footbot(scene, "fb", 0, 0);
  scene.cylinder(kR + gap_m + 0.1, 0, 0.1).movable(mass_kg);
  return scene;
}

double bearing_of_thing(const MadeWorld& world) {
  const Pose at = pose_of(world, "fb");
  return hal::wrapped(std::atan2(thing(world).y_m - at.y_m, thing(world).x_m - at.x_m) - at.heading_rad());
}

double distance_of_thing(const MadeWorld& world) {
  const Pose at = pose_of(world, "fb");
  return std::hypot(thing(world).x_m - at.x_m, thing(world).y_m - at.y_m);
}

TEST_P(Gripping, WhatIsHeldComesAlongBackwardAndStaysWhenLetGo) {
  auto world = made(with_cylinder(scene()));
  command<GripperDrive>(world, "fb").lock();
  steps(world, 2);
  ASSERT_TRUE(reading<Gripper>(world, "fb").holding);
  EXPECT_NEAR(reading<Gripper>(world, "fb").aperture_rad, 0.5 * kPi, 1e-6);
  const double apart = distance_of_thing(world);
  command<WheelSpeeds>(world, "fb").set(-0.1, -0.1);
  steps(world, 50);
  EXPECT_LT(pose_of(world, "fb").x_m, -0.4);
  EXPECT_NEAR(distance_of_thing(world), apart, 0.005);
  EXPECT_NEAR(bearing_of_thing(world), 0.0, 0.03);
  command<GripperDrive>(world, "fb").unlock();
  steps(world, 50);
  EXPECT_FALSE(reading<Gripper>(world, "fb").holding);
  EXPECT_GT(distance_of_thing(world), apart + 0.3) << "it stayed behind";
  EXPECT_EQ(world->state(), RunState::Running) << world->failure();
}

TEST_P(Gripping, ClosedClawsAndShortOnesHoldNothing) {
  auto world = made(with_cylinder(scene(), hal::footbot::kind().part<hal::GripperPart>()->reach_m + 0.005));
  command<GripperDrive>(world, "fb").lock();
  steps(world, 5);
  EXPECT_FALSE(reading<Gripper>(world, "fb").holding) << "half a centimetre too far";
  auto near = made(with_cylinder(scene(), hal::footbot::kind().part<hal::GripperPart>()->reach_m - 0.005));
  command<GripperDrive>(near, "fb").aperture_rad = 0.2 * kPi;
  steps(near, 5);
  EXPECT_FALSE(reading<Gripper>(near, "fb").holding) << "not open enough";
  command<GripperDrive>(near, "fb").aperture_rad = -0.3 * kPi;
  steps(near, 1);
  EXPECT_TRUE(reading<Gripper>(near, "fb").holding);
}

TEST_P(Gripping, LooksWhereTheTurretLooks) {
  Scene s = scene();
  add_footbot(s, "fb", 0, 0, 0.3);
  s.cylinder((kR + 0.11) * std::cos(0.3 + 2.0), (kR + 0.11) * std::sin(0.3 + 2.0), 0.1).movable(0.2);
  auto world = made(s);
  command<GripperDrive>(world, "fb").lock();
  steps(world, 3);
  EXPECT_FALSE(reading<Gripper>(world, "fb").holding);
  command<TurretDrive>(world, "fb").go_to(2.0);
  steps(world, 20);
  EXPECT_TRUE(reading<Gripper>(world, "fb").holding);
}

TEST_P(Gripping, DoesNotHoldWallsLowThingsOrWhatLiesBehindThem) {
  Scene wall = scene();
  add_footbot(wall, "fb", 0, 0);
  wall.box(kR + 0.012, 0, 0.01, 0.5).cylinder(kR + 0.02 + 0.05, 0, 0.05).movable(0.1);
  auto world = made(wall);
  command<GripperDrive>(world, "fb").lock();
  steps(world, 5);
  EXPECT_FALSE(reading<Gripper>(world, "fb").holding) << "the thin wall is in the way";

  Scene low = scene();
  add_footbot(low, "fb", 0, 0);
  low.box(kR + 0.06, 0, 0.1, 0.1, 0.0, 0.05).movable(0.1);
  auto below = made(low);
  command<GripperDrive>(below, "fb").lock();
  steps(below, 5);
  EXPECT_FALSE(reading<Gripper>(below, "fb").holding) << "it ends beneath the claws";
}

TEST_P(Gripping, ThePassiveTurretLetsTheBodyTurnBeneathTheLoad) {
  auto world = made(with_cylinder(scene(), 0.01, 20.0));  // heavy: it stays
  command<GripperDrive>(world, "fb").lock();
  command<TurretDrive>(world, "fb").let_go();
  steps(world, 2);
  ASSERT_TRUE(reading<Gripper>(world, "fb").holding);
  command<WheelSpeeds>(world, "fb").set(-0.05, 0.05);
  steps(world, 20);
  const double turned = pose_of(world, "fb").heading_rad();
  EXPECT_NEAR(turned, 0.1 / hal::footbot::kind().drive()->wheel_base_m * 2.0, 0.2);
  EXPECT_NEAR(reading<TurretEncoder>(world, "fb").angle_rad, -turned, 0.05) << "the turret stays on the load";
  EXPECT_NEAR(bearing_of_thing(world), reading<TurretEncoder>(world, "fb").angle_rad, 0.05);
}

TEST_P(Gripping, TheTurretSwingsAndAimsALightLoad) {
  auto world = made(with_cylinder(scene(), 0.01, 0.1));
  command<GripperDrive>(world, "fb").lock();
  steps(world, 2);
  ASSERT_TRUE(reading<Gripper>(world, "fb").holding);
  command<TurretDrive>(world, "fb").turn(0.5);
  steps(world, 10);
  EXPECT_NEAR(reading<TurretEncoder>(world, "fb").angle_rad, 0.5, 0.1) << "counter-clockwise is positive";
  EXPECT_NEAR(bearing_of_thing(world), reading<TurretEncoder>(world, "fb").angle_rad, 0.03);
  command<TurretDrive>(world, "fb").go_to(-1.0);
  steps(world, 40);
  EXPECT_NEAR(bearing_of_thing(world), -1.0, 0.06);
  EXPECT_TRUE(reading<Gripper>(world, "fb").holding);
}

TEST_P(Gripping, FootbotsAssembleToAChainThatIsPulledAlong) {
  Scene s = scene(6.0);
  const double apart = 2 * kR + 0.02;
  add_footbot(s, "head", 0, 0, kPi);  // looks away from the others
  add_footbot(s, "middle", apart, 0, kPi);
  add_footbot(s, "tail", 2 * apart, 0, kPi);
  auto world = made(s);
  for (const std::string id : {"middle", "tail"}) {
    command<GripperDrive>(world, id).lock();
    command<TurretDrive>(world, id).let_go();
  }
  steps(world, 3);
  ASSERT_TRUE(reading<Gripper>(world, "middle").holding);
  ASSERT_TRUE(reading<Gripper>(world, "tail").holding);
  for (const std::string id : {"head", "middle", "tail"}) command<WheelSpeeds>(world, id).set(0.1, 0.1);
  steps(world, 30);
  command<WheelSpeeds>(world, "head").set(0.06, 0.1);  // the chain follows through a bend
  steps(world, 30);
  const Pose a = pose_of(world, "head"), b = pose_of(world, "middle"), c = pose_of(world, "tail");
  EXPECT_LT(a.x_m, -0.4);
  EXPECT_NEAR(std::hypot(a.x_m - b.x_m, a.y_m - b.y_m), apart, 0.01);
  EXPECT_NEAR(std::hypot(b.x_m - c.x_m, b.y_m - c.y_m), apart, 0.01);
  EXPECT_EQ(world->state(), RunState::Running) << world->failure();
}

TEST_P(Gripping, AnEpuckCannotBeHeld) {
  Scene s = scene();
  add_footbot(s, "fb", 0, 0);
  ControllerConfig other = s.scenario.controllers.back();
  other.id = "other";
  other.label = "drive";
  other.sensors.clear();
  other.actuators = {{"differential_steering", "default", {}}};
  s.scenario.controllers.push_back(other);
  s.robot("ep", kR + 0.045, 0);
  s.scenario.robots.back().controller = 1;
  auto world = made(s);
  command<GripperDrive>(world, "fb").lock();
  steps(world, 5);
  EXPECT_FALSE(reading<Gripper>(world, "fb").holding);
}

TEST_P(Gripping, LetsGoWhenItsControllerIsStoppedOrTheLoadVanishes) {
  Scene s = scene();
  add_footbot(s, "a", 0, 0);
  add_footbot(s, "b", 2 * kR + 0.02, 0);
  auto world = made(s);
  command<GripperDrive>(world, "a").lock();
  steps(world, 2);
  ASSERT_TRUE(reading<Gripper>(world, "a").holding);
  Space& space = world->space();
  space.remove_robot(space.find_robot("b"));
  steps(world, 2);
  EXPECT_FALSE(reading<Gripper>(world, "a").holding);

  auto halted = made(with_cylinder(scene()));
  command<GripperDrive>(halted, "fb").lock();
  steps(halted, 2);
  ASSERT_TRUE(reading<Gripper>(halted, "fb").holding);
  halted->space().set_halted(halted->space().find_robot("fb"), true);
  steps(halted, 2);
  EXPECT_FALSE(reading<Gripper>(halted, "fb").holding);
}

TEST_P(Gripping, AFailingGripperHoldsLater) {
  Scene s = with_cylinder(scene());
  choose(s, "gripper", hal::Role::Actuator, "default", {{"failure_prob", "1", 11}});
  auto never = made(s);
  command<GripperDrive>(never, "fb").lock();
  steps(never, 20);
  EXPECT_FALSE(reading<Gripper>(never, "fb").holding);
  choose(s, "gripper", hal::Role::Actuator, "default", {{"failure_prob", "0.5", 11}});
  int ticks = 0;
  for (std::uint64_t seed = 1; seed <= 100; ++seed) {
    WorldOptions options;
    options.seed = seed;
    auto world = made(s, options);
    command<GripperDrive>(world, "fb").lock();
    do {
      world->step();
      ++ticks;
    } while (!reading<Gripper>(world, "fb").holding && ticks < 1000);
  }
  EXPECT_NEAR(ticks / 100.0, 2.0, 0.5) << "a fair coin falls at the second throw, in the mean";
}

TEST_P(Gripping, EveryGripDrawsTheTreelsSlantAnew) {
  Scene s = with_cylinder(scene(), 0.01, 0.05);
  choose(s, "differential_steering", hal::Role::Actuator, "slanted");
  auto world = made(s);
  const auto slant = [&world] {
    const Space& space = world->space();
    return space.state<HiddenRoll>(space.find_robot("fb"))->left_m_s;
  };
  command<WheelSpeeds>(world, "fb").set(-0.01, -0.01);
  steps(world, 2);
  const double first = slant();
  EXPECT_NE(first, 0.0);
  steps(world, 5);
  EXPECT_EQ(slant(), first);
  command<GripperDrive>(world, "fb").lock();
  steps(world, 3);
  ASSERT_TRUE(reading<Gripper>(world, "fb").holding);
  const double second = slant();
  EXPECT_NE(second, first);
  steps(world, 5);
  EXPECT_EQ(slant(), second);
}

TEST_P(Gripping, HoldsAcrossTheBorderOfTwoRegions) {
  Scene s = with_cylinder(scene(4.0));
  s.split("2x1");  // the border is x = 0: the load is east of it, the robot upon it
  auto world = made(s);
  command<GripperDrive>(world, "fb").lock();
  steps(world, 2);
  ASSERT_TRUE(reading<Gripper>(world, "fb").holding);
  const double apart = distance_of_thing(world);
  command<WheelSpeeds>(world, "fb").set(-0.2, -0.2);
  steps(world, 50);
  EXPECT_LT(pose_of(world, "fb").x_m, -0.8);
  EXPECT_NEAR(distance_of_thing(world), apart, 0.01);
}

TEST_P(Gripping, GoesOnAlikeFromASnapshotTakenWhileTheTurretSwingsItsLoad) {
  Scene s = with_cylinder(scene());
  choose(s, "differential_steering", hal::Role::Actuator, "slanted");
  auto world = made(s);
  command<GripperDrive>(world, "fb").lock();
  command<TurretDrive>(world, "fb").turn(0.4);
  command<WheelSpeeds>(world, "fb").set(-0.05, -0.05);
  steps(world, 5);
  ASSERT_TRUE(reading<Gripper>(world, "fb").holding);
  const auto kept = world->snapshot();
  ASSERT_TRUE(kept.ok()) << kept.error().message;
  steps(world, 10);
  command<GripperDrive>(world, "fb").unlock();
  steps(world, 10);
  const std::uint64_t first = world->state_hash();
  ASSERT_TRUE(world->restore(kept.value()).ok());
  EXPECT_TRUE(reading<Gripper>(world, "fb").holding);
  steps(world, 10);
  EXPECT_TRUE(reading<Gripper>(world, "fb").holding);
  command<GripperDrive>(world, "fb").unlock();
  steps(world, 10);
  EXPECT_EQ(world->state_hash(), first);
}

TEST_P(Gripping, IsAlikeForAnyNumberOfThreadsAndRegions) {
  std::uint64_t first = 0;
  for (const std::int64_t threads : {1, 2, 4}) {
    Scene s = scene(6.0);
    s.split("2x2").walls();
    for (int i = 0; i < 60; ++i)
      add_footbot(s, "fb" + std::to_string(i), 0.19 * (i % 10) - 0.9, 0.19 * (i / 10) - 0.5, 0.9 * i);
    WorldOptions options;
    options.threads = threads;
    auto world = made(s, options);
    for (int i = 0; i < 60; ++i) {
      const std::string id = "fb" + std::to_string(i);
      command<WheelSpeeds>(world, id).set(0.05, 0.08);
      command<TurretDrive>(world, id).turn(0.02 * i - 0.6);
      if (i % 3 == 0) command<GripperDrive>(world, id).lock();
    }
    steps(world, 40);
    for (int i = 0; i < 60; i += 6) command<GripperDrive>(world, "fb" + std::to_string(i)).unlock();
    steps(world, 20);
    EXPECT_EQ(world->state(), RunState::Running) << world->failure();
    int holding = 0;
    for (int i = 0; i < 60; ++i) holding += reading<Gripper>(world, "fb" + std::to_string(i)).holding ? 1 : 0;
    EXPECT_GT(holding, 2);
    if (first == 0) first = world->state_hash();
    EXPECT_EQ(world->state_hash(), first) << threads << " threads";
  }
}

TEST(GrippingAtLoad, EnginesWithoutForcesRefuseARobotThatGrips) {
  for (const std::string engine : {"kinematics2d", "particle3d"}) {
    Scene s = footbot_scene(engine);
    add_footbot(s, "fb", 0, 0);
    s.scenario.robots.back().line = 42;
    const auto world = make(s);
    EXPECT_FALSE(world.world) << engine;
    EXPECT_THAT(world.all_problems(),
                HasSubstr("scene:42: error: robot 'fb' has a gripper, but its engine '" + engine +
                          "' has no joints, but fixed and turning ones are needed; use dynamics2d, dynamics3d"));
  }
}

TEST(GrippingAtLoad, OtherDevicesDoWithoutForces) {
  Scene s = footbot_scene("kinematics2d", 4.0, "driven_puppet");
  add_footbot(s, "fb", 0, 0);
  auto world = made(s);
  ASSERT_TRUE(world.world);
  command<WheelSpeeds>(world, "fb").set(0.1, 0.1);
  steps(world, 10);
  EXPECT_NEAR(pose_of(world, "fb").x_m, 0.1, 1e-9);
  EXPECT_EQ(world->space().state<GripState>(world->space().find_robot("fb")), nullptr);
  EXPECT_EQ(world->space().turret_rad(world->space().find_robot("fb")), 0.0);
}

}  // namespace
}  // namespace tandem::core
