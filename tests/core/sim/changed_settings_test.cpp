// Going on with other settings: what is not said otherwise goes on to the bit, what is holds from then on.
#include <gmock/gmock.h>
#include <gtest/gtest.h>
#include <set>

#include "core/space/mechanisms.hpp"
#include "core/space/stores.hpp"
#include "hal/device/gripper.hpp"
#include "hal/device/range_and_bearing.hpp"
#include "hal/device/wheels.hpp"
#include "tests/core/footbots.hpp"
#include "tests/core/scenes.hpp"

namespace tandem::core {
namespace {

using testing::HasSubstr;

constexpr hal::Tick kChange = 20, kTicks = 60;

/// One more configuration of the first one's devices; robots choose it by `who`.
Scene& second(Scene& scene, const std::string& controller = "drive") {
  ControllerConfig config = scene.scenario.controllers.front();
  config.id = "d";
  config.label = controller;
  config.params = {};
  scene.scenario.controllers.push_back(config);
  return scene;
}

RobotItem& item(Scene& scene, const std::string& id) {
  for (RobotItem& robot : scene.scenario.robots) {
    if (robot.id == id) return robot;
  }
  return scene.scenario.robots.front();
}

/// The fingerprints after each tick, of a run that goes on with `changed` at kChange; `look` is called then, and after
/// every tick.
std::vector<std::uint64_t> hashes(const Scene& scene, const Scene* changed, std::int64_t threads = 0,
                                  const std::function<void(World&)>& look = {}) {
  WorldOptions options;
  options.threads = threads;
  MadeWorld world = make(scene, options);
  EXPECT_TRUE(world.world) << world.all_problems();
  std::vector<std::uint64_t> all;
  if (!world.world) return all;
  world->start();
  world->begin_saving();
  for (hal::Tick tick = 0; tick < kTicks; ++tick) {
    if (tick == kChange && changed != nullptr) {
      const hal::Status went_on = world->continue_with(changed->scenario);
      EXPECT_TRUE(went_on.ok()) << went_on.error().message;
      if (look) look(*world.world);
    }
    world->step();
    all.push_back(world->state_hash());
    if (look) look(*world.world);
  }
  EXPECT_EQ(world->state(), RunState::Running) << world->failure();
  return all;
}

hal::Tick first_difference(const std::vector<std::uint64_t>& a, const std::vector<std::uint64_t>& b) {
  EXPECT_EQ(a.size(), b.size());
  for (std::size_t i = 0; i < std::min(a.size(), b.size()); ++i) {
    if (a[i] != b[i]) return static_cast<hal::Tick>(i);
  }
  return static_cast<hal::Tick>(a.size());
}

/// Robots that sense and talk with noise and drive into one another and crates, some with parameters of their own; a
/// hook brings others and takes them out again.
Scene crowd(const std::string& kind, const std::string& left = "0.06") {
  Scene s(4.0, "everything");
  s.engine(kind).param("left", left).param("right", "0.05").implementations("noisy").walls().robots(40, 0.6);
  if (kind != "particle3d") s.split("2x2");
  s.scenario.escape = EscapePolicy::Stop;
  s.scenario.robots[0].battery.delta = 0.001;
  second(s, "counting_drive").robot("alone", 1.2, 1.2);
  item(s, "alone").battery = s.scenario.robots[0].battery;
  if (test::engine_traits(kind).forces) s.box(1.0, 0, 0.1, 0.2, 0.0, 0.06).movable(0.2);
  return with_hook(s, "shepherd");
}

class Continued : public testing::TestWithParam<std::string> {};
INSTANTIATE_TEST_SUITE_P(Engines, Continued, testing::ValuesIn(test::engine_kinds()),
                         [](const auto& kind) { return kind.param; });

TEST_P(Continued, WithEqualSettingsIsTheSameRunInEveryTick) {
  const Scene scene = crowd(GetParam());
  const auto expected = hashes(scene, nullptr);
  Scene equal = crowd(GetParam(), "0.060");                              // the same number
  equal.scenario.controllers[1].params.attributes = {{"left", "0", 0}};  // the default, written out
  EXPECT_EQ(hashes(scene, &equal), expected);
  EXPECT_EQ(hashes(scene, &equal, 2), expected);
  const Scene in_cm = crowd(GetParam(), "6 cm/s");
  EXPECT_EQ(hashes(scene, &in_cm), expected);
}

TEST_P(Continued, WithOtherControllersParametersAndDevicesIsTheSameRunUntilThenForAnyThreads) {
  const Scene scene = crowd(GetParam());
  const auto before = hashes(scene, nullptr);
  Scene other = crowd(GetParam(), "0.02");
  item(other, "alone").controller = 0;  // it had the first as well
  item(other, "ep").controller = 1;
  Scene noisier = scene;
  for (DeviceChoice& choice : noisier.scenario.controllers[0].sensors) {
    if (choice.device == "proximity") choice.implementation = "default";
  }
  for (const Scene* changed : {&other, &noisier}) {
    const auto after = hashes(scene, changed);
    EXPECT_EQ(first_difference(before, after), kChange);
    EXPECT_EQ(hashes(scene, changed, 2), after);
  }
}

/// Two robots far from each other, one of which may get another controller.
Scene two(const std::string& controller = "counting_drive") {
  Scene s(4.0, controller);
  s.param("left", "0.05").param("right", "0.05").robot("a", -1.0, -1.0).robot("b", -1.0, 1.0);
  s.scenario.robots[0].battery.delta = s.scenario.robots[1].battery.delta = 0.001;
  second(s, controller);
  s.scenario.controllers[1].params.attributes = {{"left", "-0.02", 0}, {"right", "-0.02", 0}};
  return s;
}

double x_of(const World& world, const char* robot) {
  return world.space().pose(world.space().find_robot(robot)).x_m;
}
int steps_of(World& world, const char* robot) {
  return world.space().port<hal::RangeAndBearingSend>(world.space().find_robot(robot))->payload[0];
}

TEST(Continued, ARobotWithAnotherControllerGoesOnWhereItWasAndTheOthersAsTheyDid) {
  Scene changed = two();
  item(changed, "a").controller = 1;
  const double before_m = -1.0 + 0.05 * 0.1 * (kChange - 1);  // a command acts in the tick after it
  RobotId a;
  hashes(two(), &changed, 0, [&](World& world) {
    Space& space = world.space();
    if (world.tick() == 1) a = space.find_robot("a");
    if (world.tick() == kChange) {
      EXPECT_EQ(space.find_robot("a"), a) << "the same robot";
      EXPECT_NEAR(x_of(world, "a"), before_m, 1e-12);
      EXPECT_NEAR(space.stores().bodies.left_m[space.stores().row_of(a)], before_m + 1.0, 1e-12);
    }
    if (world.tick() <= kChange) return;
    // It is given safe commands, as a robot that is added: its first ones act a tick later.
    EXPECT_NEAR(x_of(world, "a"), before_m - 0.02 * 0.1 * static_cast<double>(world.tick() - kChange - 1), 1e-12);
    EXPECT_EQ(steps_of(world, "a"), world.tick() - kChange);
    EXPECT_NEAR(x_of(world, "b"), -1.0 + 0.05 * 0.1 * static_cast<double>(world.tick() - 1), 1e-12);
    EXPECT_EQ(steps_of(world, "b"), world.tick());
    EXPECT_EQ(space.robot_count(), 2U);
  });
}

TEST(Continued, ARobotWithAnotherControllerHasTheChargeThatItHad) {
  Scene changed = two("everything");
  item(changed, "a").controller = 1;
  hashes(two("everything"), &changed, 0, [](World& world) {
    const RobotId a = world.space().find_robot("a");
    if (world.tick() == 0) return;
    EXPECT_NEAR(world.space().state<ChargeState>(a)->charge, 1.0 - 0.001 * static_cast<double>(world.tick()), 1e-9);
  });
}

TEST(Continued, ControllersRememberWhatTheyDidWithOtherParametersAndWithOtherDevices) {
  Scene params = two();
  params.scenario.controllers[0].params.attributes = {{"left", "0.01", 0}, {"right", "0.01", 0}};
  hashes(two(), &params, 0, [](World& world) {
    EXPECT_EQ(steps_of(world, "a"), world.tick());
    if (world.tick() <= kChange) return;
    EXPECT_DOUBLE_EQ(world.space().port<hal::WheelSpeeds>(world.space().find_robot("a"))->left_m_s, 0.01);
  });
  Scene devices = two();
  for (DeviceChoice& choice : devices.scenario.controllers[0].actuators) {
    if (choice.device == "differential_steering") choice.implementation = "noisy";
  }
  const auto before = hashes(two(), nullptr);
  const auto after = hashes(two(), &devices, 0, [](World& world) { EXPECT_EQ(steps_of(world, "a"), world.tick()); });
  EXPECT_EQ(first_difference(before, after), kChange);
}

TEST(Continued, ControllersWhoseMemoryCannotBeToldApartBeginAnewWhichIsSaid) {
  for (const std::string controller : {"counting_drive", "owning_drive"}) {
    std::vector<std::string> messages;
    WorldOptions options;
    options.log = hal::Log([&](hal::Severity, std::string_view text) { messages.emplace_back(text); });
    MadeWorld world = make(two(controller), options);
    world->start();
    if (controller == "owning_drive") world->begin_saving();  // of the other nobody knows how it began
    for (int i = 0; i < 5; ++i) world->step();
    Scene params = two(controller);
    params.scenario.controllers[0].params.attributes = {{"left", "0.01", 0}, {"right", "0.01", 0}};
    ASSERT_TRUE(world->continue_with(params.scenario).ok());
    world->step();
    EXPECT_EQ(steps_of(*world.world, "a"), 1);
    ASSERT_EQ(messages.size(), 1U);
    EXPECT_THAT(messages[0], HasSubstr("robots begin anew with the changed settings: the controller '" + controller));
  }
}

TEST(Continued, ParametersOfOneRobotAreItsAlone) {
  Scene changed = two();
  item(changed, "a").params = Element{"params", "scene", 0, {{"left", "0.01", 0}, {"right", "0.01", 0}}, {}};
  hashes(two(), &changed, 0, [](World& world) {
    if (world.tick() <= kChange) return;
    EXPECT_EQ(steps_of(world, "a"), world.tick() - kChange);
    EXPECT_EQ(steps_of(world, "b"), world.tick());
    const auto* const wheels = world.space().port<hal::WheelSpeeds>(world.space().find_robot("a"));
    EXPECT_DOUBLE_EQ(wheels->left_m_s, 0.01);
  });
}

TEST(Continued, ARobotThatIsHaltedStaysSoAndOneThatHoldsAThingLetsItGo) {
  Scene scene = footbot_scene("dynamics2d");
  const double radius_m = hal::footbot::kind().body.radius_m;
  add_footbot(scene, "fb", 0.0, 0.0);
  add_footbot(scene, "other", 0.0, 1.0);
  scene.cylinder(radius_m + 0.11, 0.0, 0.1).movable(0.2);
  second(scene, "driven_puppet");
  Scene changed = scene;
  item(changed, "fb").controller = item(changed, "other").controller = 1;
  bool held = false;
  hashes(scene, &changed, 0, [&](World& world) {
    Space& space = world.space();
    const RobotId robot = space.find_robot("fb"), other = space.find_robot("other");
    if (world.tick() < kChange) {
      auto& gripper = *space.port<hal::GripperDrive>(robot);
      gripper.aperture_rad = 1.5;
      held = space.holding(robot);
      space.set_halted(other, true, HaltOwner::Operator);
    }
    if (world.tick() <= kChange) return;
    EXPECT_FALSE(space.holding(robot));
    for (const Joint& joint : space.stores().joints) EXPECT_FALSE(joint.alive);
    EXPECT_TRUE(space.halted(other));
    EXPECT_FALSE(space.halted(robot));
  });
  EXPECT_TRUE(held);
}

/// What the hook published in the last tick.
double measured(const Scene& scene, const Scene& changed, const char* name) {
  double value = 0.0;
  hashes(scene, &changed, 0, [&](World& world) { value = world.measures().get(name); });
  return value;
}

Scene taught(const std::string& pace) {
  Scene s(4.0, "shown");
  s.robot("a", 0.0, 0.0);
  return with_hook(s, "teacher", {{"pace", pace, 9}});
}

TEST(Continued, AHookWithOtherOptionsHasThemFromThenOn) {
  const Scene scene = taught("1"), slower = taught("0.5"), equal = taught("1.0");
  const auto before = hashes(scene, nullptr);
  EXPECT_EQ(hashes(scene, &equal), before);
  // It tells the controllers after their step; what they draw then drives the robot a tick later.
  const hal::Tick first = first_difference(before, hashes(scene, &slower));
  EXPECT_GE(first, kChange);
  EXPECT_LE(first, kChange + 2);
  EXPECT_EQ(measured(scene, slower, "steps"), kTicks) << "measures go on";
}

TEST(Continued, AHookGetsBackWhatItSaved) {
  Scene scene = crowd("kinematics2d"), changed = scene;
  changed.scenario.hooks[0].options.attributes = {{"movable", "false", 9}, {"times", "2", 9}};
  EXPECT_EQ(hashes(scene, &changed), hashes(scene, nullptr)) << "it goes on with its flock";
}

/// With a lamp, a box, and a picture of a floor.
Scene furnished(double intensity, double box_x_m, const std::string& source = "none") {
  Scene s = two();
  LightItem lamp;
  lamp.id = "lamp";
  lamp.intensity = intensity;
  s.scenario.lights.push_back(lamp);
  s.box(box_x_m, 0.0, 0.1, 0.1);
  return s.field("floor", {{"source", source, 5}, {"path", test::kSourceDir + std::string("/docs/povray.png"), 5}});
}

TEST(Continued, LightsBoxesAndFloorsAreAsTheSettingsSayWhereTheRunHasNotChangedThem) {
  const Scene changed = furnished(3.0, 1.5, "image");
  hashes(furnished(1.0, 1.0), &changed, 0, [](World& world) {
    const bool on = world.tick() > kChange;
    if (world.tick() == kChange) return;
    const SpaceStores& s = world.space().stores();
    EXPECT_EQ(world.space().lights()[0].intensity, on ? 3.0 : 1.0);
    EXPECT_EQ(s.objects[0].x_m, on ? 1.5 : 1.0);
    EXPECT_EQ(s.fields.find("floor")->mark() != 0, on);
  });
}

TEST(Continued, AFloorThatHooksPaintStaysAndIsNamed) {
  Scene painted = furnished(1.0, 1.0, "loop_functions");
  painted.scenario.hooks.push_back({"test_hooks", "dial", {}, 9});
  Scene changed = painted;
  changed.scenario.fields[0].attributes[0].value = "none";
  MadeWorld world = make(painted);
  EXPECT_THAT(world->can_continue_with(changed.scenario).error().message, HasSubstr("the floor, which hooks paint"));
}

TEST(Continued, WhatTheRunHasChangedAndTheSettingsTooFailsItByName) {
  MadeWorld world = make(furnished(1.0, 1.0));
  world->start();
  LightSource lamp = world->space().lights()[0];
  lamp.intensity = 2.0;
  world->space().set_light(0, lamp);
  EXPECT_THAT(world->continue_with(furnished(3.0, 1.0).scenario).error().message,
              HasSubstr("the run has changed the light 'lamp', and so have the settings"));
  EXPECT_EQ(world->state(), RunState::Failed);
}

std::string refusal(const Scene& scene, const Scene& changed) {
  MadeWorld world = make(scene);
  const std::uint64_t before = world->state_hash();
  const hal::Status can = world->can_continue_with(changed.scenario);
  EXPECT_FALSE(world->continue_with(changed.scenario).ok());
  EXPECT_EQ(world->state(), RunState::Running);
  EXPECT_EQ(world->state_hash(), before);
  return can.ok() ? "" : can.error().message;
}

TEST(Continued, WhatCannotChangeIsNamedAndNothingHasChanged) {
  const Scene scene = two();
  Scene more = two(), faster = two(), larger = two(), engine = two(), kind = two(), library = two(), hook = two(),
        seed = two();
  more.robot("c", 0.0, 0.0);
  faster.scenario.ticks_per_second = 20;
  larger.scenario.arena_size = {5.0, 5.0, 1.0};
  engine.engine("dynamics2d");
  kind.scenario.robots[0].kind = "foot-bot";
  library.scenario.controllers[1].label = "drive";
  seed.scenario.seed = 8;
  hook.scenario.hooks.push_back({"test_hooks", "teacher", {}, 9});
  EXPECT_THAT(refusal(scene, more), HasSubstr("arena: its robots"));
  EXPECT_THAT(refusal(scene, faster), HasSubstr("ticks_per_second"));
  EXPECT_THAT(refusal(scene, seed), HasSubstr("random_seed"));
  EXPECT_THAT(refusal(scene, larger), HasSubstr("arena.size"));
  EXPECT_THAT(refusal(scene, engine), HasSubstr("physics_engines"));
  EXPECT_THAT(refusal(scene, kind), HasSubstr("arena: its robots"));
  EXPECT_THAT(refusal(scene, library), HasSubstr("controllers"));
  EXPECT_THAT(refusal(scene, hook), HasSubstr("loop_functions"));
}

TEST(Continued, AControllerThatCannotBeMadeThereFailsTheRunByName) {
  Scene scene = two("drive");
  second(scene, "stillborn").scenario.controllers.back().id = "e";
  Scene changed = scene;
  item(changed, "a").controller = 2;
  MadeWorld world = make(scene);
  world->start();
  world->step();
  EXPECT_FALSE(world->continue_with(changed.scenario).ok());
  EXPECT_EQ(world->state(), RunState::Failed);
  EXPECT_THAT(world->failure(), HasSubstr("controller 'e'"));
  EXPECT_THAT(world->failure(), HasSubstr("robot 'a'"));
}

TEST(Begun, AResetWithOtherSettingsIsTheirRun) {
  Scene changed = furnished(2.0, 1.5, "image");
  changed.scenario.controllers[0].params.attributes = {{"left", "0.01", 0}, {"right", "0.01", 0}};
  MadeWorld fresh = make(changed), again = make(furnished(1.0, 1.0));
  for (MadeWorld* world : {&fresh, &again}) (*world)->start();
  for (int i = 0; i < 5; ++i) again->step();
  for (int round = 0; round < 2; ++round) {
    const hal::Status begun = again->reset(7, round == 0 ? &changed.scenario : nullptr);
    ASSERT_TRUE(begun.ok()) << begun.error().message;
    for (int i = 0; i < 5; ++i) {
      if (round == 0) fresh->step();
      again->step();
    }
    EXPECT_EQ(again->state_hash(), fresh->state_hash());
  }
}

TEST(Begun, WhatAResetCannotChangeIsNamedAndNothingHasChanged) {
  Scene engine = two(), other = two(), wrong = two();
  engine.engine("dynamics2d");
  item(other, "a").controller = 1;
  wrong.scenario.controllers[0].params.attributes = {{"lefd", "0.01", 0}};
  MadeWorld world = make(two());
  world->start();
  const std::uint64_t before = world->state_hash();
  const auto refused = [&](const Scene& scene) { return world->reset(7, &scene.scenario).error().message; };
  EXPECT_THAT(refused(engine), HasSubstr("physics_engines; make another world"));
  EXPECT_THAT(refused(other), HasSubstr("the controller of 'a'"));
  EXPECT_THAT(refused(wrong), HasSubstr("lefd"));
  EXPECT_EQ(world->state_hash(), before);
}

TEST(Continued, ThereIsNoWayBackBehindIt) {
  Scene changed = two();
  item(changed, "a").controller = 1;
  MadeWorld world = make(two());
  world->start();
  const auto snapshot = world->snapshot();
  ASSERT_TRUE(world->continue_with(changed.scenario).ok());
  EXPECT_FALSE(world->restore(snapshot.value()).ok());
  EXPECT_THAT(world->reset(1).error().message, HasSubstr("other settings"));
  const auto later = world->snapshot();  // but to what came after
  world->step();
  const std::uint64_t once = world->state_hash();
  ASSERT_TRUE(world->restore(later.value()).ok());
  world->step();
  EXPECT_EQ(world->state_hash(), once);
}

}  // namespace
}  // namespace tandem::core
