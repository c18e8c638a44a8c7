// Going on in another world from what one wrote: to the last bit, or refused by name.
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "core/space/stores.hpp"
#include "tests/core/footbots.hpp"
#include "tests/core/scenes.hpp"

namespace tandem::core {
namespace {

using testing::HasSubstr;

std::vector<std::uint64_t> hashes(World& world, int steps) {
  std::vector<std::uint64_t> all;
  for (int i = 0; i < steps; ++i) {
    world.step();
    all.push_back(world.state_hash());
  }
  return all;
}

/// As the crowds of snapshot_test.
Scene crowd(const std::string& kind, const std::string& controller = "everything") {
  Scene s(4.0, controller);
  s.engine(kind).param("left", "0.06").param("right", "0.05").implementations("noisy").walls().robots(60, 0.6);
  if (kind != "particle3d") s.split("2x2");
  s.scenario.escape = EscapePolicy::Stop;
  s.scenario.robots[0].battery.delta = 0.001;
  if (test::engine_traits(kind).forces) {
    s.box(1.0, 0, 0.1, 0.2, 0.0, 0.06).movable(0.2).cylinder(-1.0, 0.0, 0.06).movable(0.1);
    s.box(0.0, 1.0, 0.1, 0.1, 0.3, 0.06).movable(0.1);
  }
  return s;
}

void start(MadeWorld& world) {
  ASSERT_TRUE(world.world) << world.all_problems();
  world->start();
  world->begin_saving();
}

std::string saved(World& world) {
  const hal::Result<std::string> bytes = world.save();
  EXPECT_TRUE(bytes.ok()) << bytes.error().message;
  return bytes.ok() ? bytes.value() : "";
}

class Saved : public testing::TestWithParam<std::string> {};
INSTANTIATE_TEST_SUITE_P(Engines, Saved, testing::ValuesIn(test::engine_kinds()),
                         [](const auto& kind) { return kind.param; });

TEST_P(Saved, WorldsGoOnElsewhereAsBefore) {
  auto one = make(crowd(GetParam()));
  start(one);
  (void)hashes(*one.world, 40);
  const std::string at_40 = saved(*one.world);
  const std::uint64_t hash = one->state_hash();
  const std::vector<std::uint64_t> first = hashes(*one.world, 60);

  auto other = make(crowd(GetParam()));
  start(other);
  const hal::Status loaded = other->load(at_40);
  ASSERT_TRUE(loaded.ok()) << loaded.error().message;
  EXPECT_EQ(other->tick(), 40);
  EXPECT_EQ(other->state_hash(), hash);
  EXPECT_EQ(hashes(*other.world, 30), std::vector(first.begin(), first.begin() + 30));

  // And from there in a third.
  auto third = make(crowd(GetParam()));
  start(third);
  ASSERT_TRUE(third->load(saved(*other.world)).ok());
  EXPECT_EQ(hashes(*third.world, 30), std::vector(first.begin() + 30, first.end()));
  EXPECT_EQ(third->state(), RunState::Running) << third->failure();
}

TEST_P(Saved, WhatHooksAndPeopleChangedIsThere) {
  auto one = make(crowd(GetParam()));
  start(one);
  (void)hashes(*one.world, 5);
  Space& space = one->space();
  space.remove_robot(space.find_robot("ep3"));
  space.set_pose(space.find_robot("ep4"), Pose::at(1.7, 1.7, 0));
  space.set_halted(space.find_robot("ep5"), true, HaltOwner::Hook);
  Object box;
  box.id = "box of somebody";
  box.x_m = -1.5;
  box.half_x_m = box.half_y_m = 0.1;
  box.z_high_m = 0.3;
  ASSERT_TRUE(space.add_object(box).ok());
  ASSERT_TRUE(space.add_light({"lamp", 0, 0, 0.3, 2.0}).ok());
  const std::string now = saved(*one.world);

  auto other = make(crowd(GetParam()));
  start(other);
  const hal::Status loaded = other->load(now);
  ASSERT_TRUE(loaded.ok()) << loaded.error().message;
  EXPECT_FALSE(other->space().find_robot("ep3").valid());
  EXPECT_TRUE(other->space().find_object("box of somebody").valid());
  EXPECT_EQ(hashes(*other.world, 30), hashes(*one.world, 30));
}

TEST_P(Saved, LoadsThatFootBotsHoldAreHeld) {
  if (!test::engine_traits(GetParam()).forces) GTEST_SKIP() << "an engine without masses";
  const auto scene = [] {
    Scene s = footbot_scene(GetParam());
    s.cylinder(hal::footbot::kind().body.radius_m + 0.11, 0, 0.1).movable(0.2);
    choose(s, "differential_steering", hal::Role::Actuator, "slanted");
    add_footbot(s, "a", 0, 0);
    return s;
  };
  auto one = make(scene());
  start(one);
  one->step();
  command<hal::GripperDrive>(one, "a").lock();
  command<hal::WheelSpeeds>(one, "a").left_m_s = -0.05;
  (void)hashes(*one.world, 20);
  ASSERT_FALSE(one->space().stores().joints.empty());
  auto other = make(scene());
  start(other);
  ASSERT_TRUE(other->load(saved(*one.world)).ok());
  EXPECT_EQ(hashes(*other.world, 50), hashes(*one.world, 50));
}

TEST(Saving, NamesControllersThatOwnMemoryOrShareIt) {
  for (const std::string name : {"owner", "sharer"}) {
    auto world = make(Scene(4.0, name).engine("kinematics2d").robot("a", 0, 0));
    start(world);
    world->step();
    const auto bytes = world->save();
    ASSERT_FALSE(bytes.ok());
    EXPECT_THAT(bytes.error().message, HasSubstr("controller '" + name + "' of robot 'a'"));
  }
}

TEST(Saving, ControllersThatSayWhatTheyRememberHaveIt) {
  const auto scene = [] { return Scene(4.0, "rememberer").engine("kinematics2d").robot("a", 0, 0).robot("b", 1, 1); };
  auto one = make(scene());
  start(one);
  (void)hashes(*one.world, 20);
  auto other = make(scene());
  start(other);
  ASSERT_TRUE(other->load(saved(*one.world)).ok());
  EXPECT_EQ(hashes(*other.world, 40), hashes(*one.world, 40));
}

TEST(Saving, NamesWhatElseNoOtherProcessCouldTakeOver) {
  auto world = make(Scene().engine("kinematics2d").robot("a", 0, 0));
  start(world);
  world->step();
  ASSERT_TRUE(world->save().ok());
  ASSERT_TRUE(world->space().add_robot({.id = "b", .controller = "c", .pose = Pose::at(1, 1, 0)}).ok());
  const auto bytes = world->save();
  ASSERT_FALSE(bytes.ok());
  EXPECT_THAT(bytes.error().message, HasSubstr("robots were added"));
}

TEST(Saving, WhatDoesNotFitIsNamed) {
  auto one = make(Scene().engine("kinematics2d").robot("a", 0, 0));
  start(one);
  one->step();
  const std::string bytes = saved(*one.world);
  const auto refused = [&](const Scene& scene) {
    auto other = make(scene);
    start(other);
    const hal::Status loaded = other->load(bytes);
    return loaded.ok() ? std::string() : loaded.error().message;
  };
  EXPECT_EQ(refused(Scene().engine("kinematics2d").robot("a", 0, 0)), "");
  EXPECT_THAT(refused(Scene().engine("kinematics2d").robot("a", 0, 0).robot("b", 1, 1)),
              HasSubstr("1 robots of group 0, where this world has 2 robots"));
  EXPECT_THAT(refused(Scene().engine("dynamics2d").robot("a", 0, 0)), HasSubstr("engine kinematics2d"));
  EXPECT_THAT(refused(Scene(4.0, "everything").engine("kinematics2d").robot("a", 0, 0)), HasSubstr("of class"));
}

/// With a lamp, a wall, and a robot between them.
Scene furnished(double intensity, double wall_m, double left_m_s = 0.02) {
  Scene s;
  s.engine("kinematics2d").robot("a", 0, 0).wheels(left_m_s, 0.02).box(1.0, 0, 0.1, wall_m).box(-1.0, 0, 0.1, 0.1);
  LightItem lamp;
  lamp.id = "lamp";
  lamp.p_W = {0.5, 0.5, 0.3};
  lamp.intensity = intensity;
  s.scenario.lights.push_back(lamp);
  return s;
}

/// Why a world of `settings` does not go on from the state; empty: it does.
std::string another_way(MadeWorld& other, const std::string& state, const Scene& before) {
  start(other);
  const hal::Status loaded = other->load(state, &before.scenario);
  return loaded.ok() ? std::string() : loaded.error().message;
}

TEST(Saving, AnotherWayOnHasWhatTheSettingsChanged) {
  const Scene before = furnished(1.0, 0.5);
  auto one = make(before);
  start(one);
  (void)hashes(*one.world, 10);
  const Pose pose = one->space().pose(one->space().find_robot("a"));
  const std::string state = saved(*one.world);

  auto same = make(furnished(1.0, 0.5));
  ASSERT_EQ(another_way(same, state, before), "");
  EXPECT_EQ(hashes(*same.world, 10), hashes(*one.world, 10));

  auto other = make(furnished(3.0, 0.7, 0.01));
  ASSERT_EQ(another_way(other, state, before), "");
  EXPECT_EQ(other->space().lights()[0].intensity, 3.0);
  EXPECT_EQ(other->space().stores().objects[0].half_y_m, 0.35);
  EXPECT_EQ(other->space().pose(other->space().find_robot("a")).x_m, pose.x_m);
  other->step();
  EXPECT_EQ(command<hal::WheelSpeeds>(other, "a").left_m_s, 0.01);
  EXPECT_EQ(other->tick(), 11);
}

TEST(Saving, WhatTheRunAndTheSettingsChangedIsNamed) {
  const Scene before = furnished(1.0, 0.5);
  auto one = make(before);
  start(one);
  one->step();
  LightSource lamp = one->space().lights()[0];
  lamp.intensity = 2.0;
  one->space().set_light(0, lamp);
  const std::string state = saved(*one.world);
  auto other = make(furnished(3.0, 0.5));
  EXPECT_THAT(another_way(other, state, before), HasSubstr("has changed the light 'lamp', and so have the settings"));
  auto wall = make(furnished(1.0, 0.6));
  ASSERT_EQ(another_way(wall, state, before), "");
  EXPECT_EQ(wall->space().lights()[0].intensity, 2.0);
}

TEST(Saving, AWallThatWouldStandOnARobotIsNamed) {
  const Scene before = furnished(1.0, 0.5);
  auto one = make(before);
  start(one);
  for (int i = 0; i < 100; ++i) one->step();
  Scene moved = furnished(1.0, 0.5);
  moved.scenario.objects[1].placement.p_W[0] = 0.2;  // free at the start
  auto other = make(moved);
  EXPECT_THAT(another_way(other, saved(*one.world), before), HasSubstr("robot 'a'"));
}

/// With a floor that a hook paints.
Scene painted(const std::string& level, const std::string& pixels_per_m = "10") {
  Scene s = furnished(1.0, 0.5);
  s.field("floor", {{"source", "loop_functions", 5}, {"pixels_per_meter", pixels_per_m, 5}});
  return with_hook(s, "dial", {{"level", level, 9}});
}

TEST(Saving, AnotherFloorIsThereAndPaintedAgain) {
  const Scene before = painted("0.25");
  auto one = make(before);
  start(one);
  (void)hashes(*one.world, 3);
  const std::string state = saved(*one.world);
  const auto floor = [](MadeWorld& world) {
    world->step();
    return world->space().stores().fields.find("floor");
  };
  auto same = make(painted("0.25"));
  ASSERT_EQ(another_way(same, state, before), "");
  EXPECT_NEAR(floor(same)->at(same->space().stores(), 0, 0, 0), 0.25, 0.01);
  EXPECT_EQ(same->state_hash(), hashes(*one.world, 1).front());

  Scene plain = painted("0.25");
  plain.scenario.fields.front().attributes = {{"source", "none", 5}};
  auto grey = make(plain);
  ASSERT_EQ(another_way(grey, state, before), "");
  EXPECT_EQ(floor(grey)->at(grey->space().stores(), 0, 0, 0), 0.5);

  auto finer = make(painted("0.75", "20"));
  ASSERT_EQ(another_way(finer, state, before), "");
  EXPECT_NEAR(floor(finer)->at(finer->space().stores(), 0, 0, 0), 0.75, 0.01);
  EXPECT_EQ(floor(finer)->grid().columns, 80U);
}

TEST(Saving, AnOptionThatIsAControlHoldsWhereNobodyTurnedIt) {
  const Scene before = painted("0.25");
  auto one = make(before);
  start(one);
  one->step();
  const std::string state = saved(*one.world);
  auto other = make(painted("0.75"));
  ASSERT_EQ(another_way(other, state, before), "");
  other->step();
  EXPECT_EQ(other->measures().get("level"), 0.75);
}

Scene tagged(bool on) {
  return Scene(4.0, "tagged").engine("kinematics2d").param("on", on ? "true" : "false").robots(20, 1.0);
}

TEST(Saving, AParameterHoldsBesideWhatChangesInItsWord) {
  const Scene before = tagged(false);
  auto one = make(before);
  start(one);
  (void)hashes(*one.world, 5);
  auto other = make(tagged(true));
  ASSERT_EQ(another_way(other, saved(*one.world), before), "");
  other->step();
  EXPECT_DOUBLE_EQ(command<hal::WheelSpeeds>(other, "ep0").right_m_s, 6e-4) << "its sixth step, and on";
}

/// Two ways to go on with other parameters: in this world, and from its state in another.
void expect_same_ways_on(const Scene& before, const Scene& changed) {
  auto one = make(before);
  start(one);
  (void)hashes(*one.world, 40);
  auto other = make(changed);
  ASSERT_EQ(another_way(other, saved(*one.world), before), "");
  auto straight = make(before);
  start(straight);
  (void)hashes(*straight.world, 40);
  const hal::Status went_on = one->continue_with(changed.scenario);
  ASSERT_TRUE(went_on.ok()) << went_on.error().message;
  const std::vector<std::uint64_t> on = hashes(*one.world, 30);
  EXPECT_EQ(on, hashes(*other.world, 30));
  EXPECT_NE(on, hashes(*straight.world, 30));
}

TEST_P(Saved, ARunThatGoesOnWithOtherParametersIsTheOneThatIsResumedWithThem) {
  Scene changed = crowd(GetParam());
  changed.scenario.controllers[0].params.attributes[0].value = "0.02";
  expect_same_ways_on(crowd(GetParam()), changed);
}

TEST(Saving, AParameterBesideAMemberThatChangesHoldsWhereverTheRunGoesOn) {
  expect_same_ways_on(tagged(false), tagged(true));
}

TEST(Saving, AnotherSeedLeavesRobotsAndTheirControllersTogether) {
  const Scene before = tagged(false);
  auto one = make(before);
  start(one);
  (void)hashes(*one.world, 5);
  WorldOptions options;
  options.seed = 99;
  options.places_seed = before.scenario.seed;
  auto other = make(tagged(false), options);
  ASSERT_EQ(another_way(other, saved(*one.world), before), "");
  other->step();
  EXPECT_EQ(other->seed(), 99U);
  for (int i = 0; i < 20; ++i) {
    const std::string id = "ep" + std::to_string(i);
    EXPECT_DOUBLE_EQ(command<hal::WheelSpeeds>(other, id.c_str()).left_m_s, 1e-4 * i) << id;
  }
}

TEST(Saving, RobotsThatChangeTheirConfigurationsAreNamed) {
  Scene before = furnished(1.0, 0.5).robot("b", 0, 1);
  before.scenario.robots[0].params.reset();
  before.scenario.controllers.push_back(before.scenario.controllers[0]);
  before.scenario.controllers[1].id = "d";
  before.scenario.robots[1].controller = 1;
  auto one = make(before);
  start(one);
  one->step();
  Scene swapped = before;
  std::swap(swapped.scenario.robots[0].controller, swapped.scenario.robots[1].controller);
  auto other = make(swapped);
  EXPECT_THAT(another_way(other, saved(*one.world), before),
              HasSubstr("cannot change on the way: the controller of 'a', the controller of 'b'"));
}

TEST(Saving, ATiltedBoxIsRefused) {
  Scene before = furnished(1.0, 0.5);
  before.scenario.engines.clear();
  before.engine("dynamics3d");
  auto one = make(before);
  start(one);
  one->step();
  Scene tilted = before;
  tilted.scenario.objects[1].placement.pitch_rad = 0.2;
  auto other = make(tilted);
  EXPECT_THAT(another_way(other, saved(*one.world), before), HasSubstr("'box1' would be put there tilted"));
}

TEST(Saving, WhatCannotChangeOnTheWayIsNamed) {
  const Scene before = furnished(1.0, 0.5);
  auto one = make(before);
  start(one);
  one->step();
  Scene larger = furnished(1.0, 0.5);
  larger.scenario.arena_size[0] = 5.0;
  auto other = make(larger);
  EXPECT_EQ(another_way(other, saved(*one.world), before), "cannot change on the way: arena.size");
}

TEST(Saving, BytesThatAreCutAreRefused) {
  const auto scene = [] { return Scene().engine("kinematics2d").robots(5, 0.5); };
  auto one = make(scene());
  start(one);
  one->step();
  const std::string bytes = saved(*one.world);
  for (std::size_t size = 0; size < bytes.size(); size += 97) {
    auto other = make(scene());
    start(other);
    EXPECT_FALSE(other->load(std::string_view(bytes).substr(0, size)).ok()) << size;
  }
}

}  // namespace
}  // namespace tandem::core
