// What hooks may do to a running world: everything comes, goes and changes, in every engine.
#include <cmath>
#include <gmock/gmock.h>
#include <gtest/gtest.h>
#include <numbers>
#include <set>

#include "core/sim/engine_factory.hpp"
#include "core/space/stores.hpp"
#include "hal/device/body_sensors.hpp"
#include "hal/device/range_and_bearing.hpp"
#include "hal/device/ring_sensors.hpp"
#include "hal/device/wheels.hpp"
#include "hal/robot/epuck.hpp"
#include "tests/core/footbots.hpp"
#include "tests/core/scenes.hpp"

namespace tandem::core {
namespace {

using testing::HasSubstr;

NewRobot at(const std::string& id, double x_m, double y_m, double heading_rad = 0.0) {
  return {.id = id, .controller = "c", .pose = Pose::at(x_m, y_m, heading_rad)};
}

Object box(const std::string& id, double x_m, double y_m, double size_x_m, double size_y_m) {
  Object object;
  object.id = id;
  object.x_m = x_m;
  object.y_m = y_m;
  object.half_x_m = 0.5 * size_x_m;
  object.half_y_m = 0.5 * size_y_m;
  object.z_high_m = 0.1;
  return object;
}

template <class T>
std::string error_of(const hal::Result<T>& result) {
  return result.ok() ? "no error" : result.error().message;
}
std::string error_of(const hal::Status& status) {
  return status.ok() ? "no error" : status.error().message;
}

float nearest_m(const Space& space, RobotId robot) {
  const auto& port = *space.port<hal::Proximity>(robot);
  return *std::min_element(port.distance_m.begin(), port.distance_m.begin() + port.count);
}

class Runtime : public testing::TestWithParam<std::string> {
 protected:
  Scene scene(const std::string& controller = "everything") const {
    Scene s(4.0, controller);
    s.engine(GetParam());
    return s;
  }
  bool forces() const { return test::engine_traits(GetParam()).forces; }
};

INSTANTIATE_TEST_SUITE_P(Engines, Runtime, testing::ValuesIn(test::engine_kinds()),
                         [](const auto& kind) { return kind.param; });

// --- robots ---

TEST_P(Runtime, AnAddedRobotDrivesSensesAndIsSeen) {
  auto world = make(scene().param("left", "0.02").param("right", "0.02").robot("old", 0, 0));
  ASSERT_TRUE(world.world) << world.all_problems();
  world->start();
  for (int i = 0; i < 3; ++i) world->step();
  Space& space = world->space();
  const RobotId old = space.find_robot("old");
  EXPECT_FLOAT_EQ(nearest_m(space, old), static_cast<float>(hal::epuck::kind().part<hal::ProximityPart>()->range_m));
  const double x_m = space.pose(old).x_m + 2.0 * hal::epuck::kind().body.radius_m + 0.05;
  const auto added = space.add_robot(at("new", x_m, 0, std::numbers::pi));  // face to face
  ASSERT_TRUE(added.ok()) << added.error().message;
  EXPECT_EQ(space.robot_count(), 2U);
  EXPECT_EQ(space.find_robot("new"), added.value());
  EXPECT_EQ(space.robot_name(added.value()), "new");
  EXPECT_EQ(space.robot(1), added.value());
  EXPECT_EQ(space.pose(added.value()).x_m, x_m);
  world->step();
  EXPECT_LT(nearest_m(space, old), 0.08F);
  EXPECT_LT(nearest_m(space, added.value()), 0.08F);
  for (int i = 0; i < 10; ++i) world->step();
  EXPECT_NEAR(space.pose(added.value()).x_m, x_m - 10 * 0.002, 2e-3);
  EXPECT_EQ(space.port<hal::RangeAndBearing>(old)->count, 1U);
  EXPECT_EQ(world->state(), RunState::Running) << world->failure();
}

TEST_P(Runtime, AnAddedRobotBumpsIntoOthers) {
  auto world = make(scene("drive").param("left", "0").param("right", "0").robot("old", 0.3, 0));
  world->start();
  world->step();
  Space& space = world->space();
  NewRobot wanted = at("new", 0, 0);
  wanted.params = {{"left", "0.1"}, {"right", "0.1"}};
  ASSERT_TRUE(space.add_robot(wanted).ok());
  for (int i = 0; i < 60; ++i) world->step();
  const Pose a = space.pose(space.find_robot("new"));
  const Pose b = space.pose(space.find_robot("old"));
  EXPECT_GT(a.x_m, 0.2);
  EXPECT_GT(std::hypot(a.x_m - b.x_m, a.y_m - b.y_m), 2.0 * hal::epuck::kind().body.radius_m - 2e-3);
}

TEST(AddRobot, SaysWhatIsWrongAndChangesNothing) {
  Scene scene(4.0, "drive");
  scene.robot("a", 0, 0).box(1, 0, 0.2, 0.2);
  scene.scenario.controllers.push_back(scene.scenario.controllers[0]);
  scene.scenario.controllers[1].id = "never";
  scene.scenario.controllers[1].label = "stillborn";
  scene.scenario.lights.emplace_back().id = "lamp";
  auto world = make(scene);
  auto twin = make(scene);
  for (MadeWorld* w : {&world, &twin}) {
    (*w)->start();
    (*w)->step();
  }
  Space& space = world->space();
  const auto error = [&](const NewRobot& wanted) { return error_of(space.add_robot(wanted)); };
  EXPECT_THAT(error(at("a", 1, 1)), HasSubstr("'a' is taken"));
  EXPECT_THAT(error(at("lamp", 1, 1)), HasSubstr("'lamp' is taken"));
  EXPECT_THAT(error(at("box0", 1, 1)), HasSubstr("'box0' is taken"));
  EXPECT_THAT(error(at("", 1, 1)), HasSubstr("empty"));
  EXPECT_THAT(error(at("b", 0.05, 0)), HasSubstr("(0.05, 0), where robot 'a' is"));
  EXPECT_THAT(error(at("b", 1.1, 0)), HasSubstr("where box 'box0' is"));
  EXPECT_THAT(error(at("b", 2.5, 0)), HasSubstr("(2.5, 0), outside the arena"));
  EXPECT_THAT(error(at("b", std::nan(""), 0)), HasSubstr("finite"));
  EXPECT_THAT(error({.kind = "e-duck", .id = "b", .controller = "c"}),
              HasSubstr("no kind 'e-duck'; there are: e-puck"));
  EXPECT_THAT(error({.id = "b", .controller = "nevr"}), HasSubstr("Did you mean 'never'?"));
  EXPECT_THAT(error({.id = "b", .controller = "never", .pose = Pose::at(1, 1, 0)}),
              HasSubstr("of robot 'b' refuses to be made"));
  NewRobot misspelt = at("b", 1, 1);
  misspelt.params = {{"lfet", "1"}};
  EXPECT_THAT(error(misspelt), HasSubstr("Did you mean 'left'?"));
  EXPECT_EQ(space.robot_count(), 1U);
  EXPECT_FALSE(space.find_robot("b").valid());
  for (int i = 0; i < 5; ++i) {
    world->step();
    twin->step();
    EXPECT_EQ(world->state_hash(), twin->state_hash());
  }
  EXPECT_EQ(error(at("b", 1, 1)), "no error");
}

TEST(AddRobot, ARefusedRobotLeavesNoPortBehind) {
  Scene scene(4.0, "picky");
  scene.robot("plain", 0, 0);
  auto world = make(scene);
  world->start();
  world->step();
  Space& space = world->space();
  EXPECT_FALSE(space.add_robot(at("refuse", 1, 1)).ok());
  EXPECT_EQ(space.ports(space.find_robot("plain")).size(), 1U);
  world->step();
  // One that takes more than the robots before it.
  const auto light = space.add_robot(at("light", 1, 1));
  ASSERT_TRUE(light.ok()) << light.error().message;
  for (int i = 0; i < 3; ++i) world->step();
  ASSERT_NE(space.port<hal::Light>(light.value()), nullptr);
  EXPECT_EQ(space.port<hal::Light>(light.value())->validity, hal::Validity::Fresh);
}

TEST_P(Runtime, ARobotThatIsGoneIsGoneForGood) {
  auto world = make(scene().robot("a", 0, 0).robot("b", 0.5, 0).robot("c", 1, 0));
  world->start();
  world->step();
  Space& space = world->space();
  const RobotId b = space.find_robot("b");
  const std::size_t row = space.stores().row_of(b);
  space.remove_robot(b);
  space.remove_robot(b);
  EXPECT_FALSE(space.contains(b));
  EXPECT_FALSE(space.find_robot("b").valid());
  EXPECT_EQ(space.robot_count(), 2U);
  EXPECT_EQ(space.robot_name(space.robot(1)), "c");
  EXPECT_EQ(space.port<hal::WheelSpeeds>(b), nullptr);
  EXPECT_TRUE(space.halted(b));
  EXPECT_THAT(error_of(space.add_robot(at("b", 0.5, 0))), HasSubstr("is taken, or was"));
  world->step();

  // Its row is used again, and what is done to the old one does not touch the new one.
  const auto next = space.add_robot(at("next", 0.5, 0));
  ASSERT_TRUE(next.ok()) << next.error().message;
  EXPECT_EQ(space.stores().row_of(next.value()), row);
  EXPECT_NE(next.value().index, b.index);
  space.set_pose(b, Pose::at(-1, -1, 0));
  space.set_halted(b, true);
  space.remove_robot(b);
  EXPECT_EQ(space.pose(next.value()).x_m, 0.5);
  EXPECT_FALSE(space.halted(next.value()));
  EXPECT_EQ(space.robot_count(), 3U);
  for (int i = 0; i < 5; ++i) world->step();
  EXPECT_EQ(world->state(), RunState::Running) << world->failure();
}

TEST_P(Runtime, ARobotStandsAsLongAsAnyoneHoldsIt) {
  auto world = make(scene().robot("a", 0, 0));
  world->start();
  world->step();
  Space& space = world->space();
  const RobotId robot = space.find_robot("a");
  space.set_halted(robot, true, HaltOwner::Safety);
  space.set_halted(robot, true);
  EXPECT_TRUE(space.halted_by(robot, HaltOwner::Hook));
  EXPECT_FALSE(space.halted_by(robot, HaltOwner::Controller));
  space.set_halted(robot, false, HaltOwner::Safety);
  EXPECT_TRUE(space.halted(robot));
  const double x_m = space.pose(robot).x_m;
  for (int i = 0; i < 5; ++i) world->step();
  EXPECT_EQ(space.pose(robot).x_m, x_m);
  space.set_halted(robot, false);
  EXPECT_FALSE(space.halted(robot));
  space.set_halted(robot, true, HaltOwner::Controller);
  space.set_halted(robot, false);
  EXPECT_TRUE(space.halted(robot));
}

TEST_P(Runtime, AUsedRowIsLikeANewOne) {
  // Two worlds: in one the newcomer gets the row of a robot that has rolled, drained its battery and drifted. Draws of
  // chance go by the number of the robot, so both are the third.
  const auto world_with = [&](bool remove) {
    Scene s = scene().param("left", "0.05").param("right", "0.06").implementations("noisy");
    s.robot("a", -1, 0).robot("b", 1, 0);
    s.scenario.robots[0].battery.delta = s.scenario.robots[1].battery.delta = 0.01;
    auto world = make(s);
    world->start();
    for (int i = 0; i < 20; ++i) world->step();
    if (remove) world->space().remove_robot(world->space().find_robot("b"));
    world->space().set_pose(world->space().find_robot("a"), Pose::at(-1.5, -1.5, 0));
    if (!remove) world->space().set_pose(world->space().find_robot("b"), Pose::at(1.5, 1.5, 0));
    EXPECT_TRUE(world->space().add_robot(at("c", 0, 0)).ok());
    for (int i = 0; i < 20; ++i) world->step();
    return world;
  };
  const auto used = world_with(true);
  const auto fresh = world_with(false);
  const RobotId a = used->space().find_robot("c");
  const RobotId b = fresh->space().find_robot("c");
  for (const hal::PortType* type : used->space().ports(a)) {
    if (type->name == hal::RangeAndBearing::kName) continue;  // the one hears one robot more
    EXPECT_EQ(hal::to_text(*type, used->space().port(a, *type)), hal::to_text(*type, fresh->space().port(b, *type)));
  }
}

TEST_P(Runtime, AFootBotComesIntoAUsedRowWithEmptyClaws) {
  Scene s = footbot_scene(GetParam());
  if (!forces()) {
    auto world = make(s);
    ASSERT_TRUE(world.world) << world.all_problems();
    for (int i = 0; i < 2; ++i) {
      const auto refused = world->space().add_robot({.kind = "foot-bot", .id = "a", .controller = "c"});
      EXPECT_THAT(error_of(refused), HasSubstr("robot 'a' has a gripper, but its engine '"));
    }
    EXPECT_EQ(world->space().robot_count(), 0U);
    world->start();
    steps(world, 2);
    EXPECT_EQ(world->state(), RunState::Running) << world->failure();
    return;
  }
  s.cylinder(hal::footbot::kind().body.radius_m + 0.11, 0, 0.1).movable(0.2);
  auto world = make(s);
  ASSERT_TRUE(world.world) << world.all_problems();
  world->start();
  world->step();
  Space& space = world->space();
  const auto a = space.add_robot({.kind = "foot-bot", .id = "a", .controller = "c"});
  ASSERT_TRUE(a.ok()) << a.error().message;
  command<hal::GripperDrive>(world, "a").lock();
  command<hal::TurretDrive>(world, "a").turn(0.5);
  command<hal::WheelSpeeds>(world, "a").set(0.1, 0.1);
  steps(world, 10);
  EXPECT_TRUE(space.holding(a.value()));
  EXPECT_GT(space.turret_rad(a.value()), 0.1);
  EXPECT_GT(reading<hal::Odometry>(world, "a").x_m, 0.02);
  const std::size_t row = space.stores().row_of(a.value());
  space.remove_robot(a.value());
  EXPECT_FALSE(space.holding(a.value()));
  EXPECT_EQ(space.turret_rad(a.value()), 0.0);
  world->step();
  const auto b = space.add_robot({.kind = "foot-bot", .id = "b", .controller = "c", .pose = Pose::at(-1, 0, 0)});
  ASSERT_TRUE(b.ok()) << b.error().message;
  EXPECT_EQ(space.stores().row_of(b.value()), row);
  EXPECT_FALSE(space.holding(b.value()));
  EXPECT_EQ(space.turret_rad(b.value()), 0.0);
  world->step();
  EXPECT_EQ(reading<hal::Odometry>(world, "b").x_m, 0.0);
  EXPECT_EQ(reading<hal::TurretEncoder>(world, "b").angle_rad, 0.0);
  EXPECT_EQ(world->state(), RunState::Running) << world->failure();
}

TEST(Robots, TenThousandComeAndGo) {
  Scene scene(40.0, "drive");
  scene.robot("first", -19, -19);
  auto world = make(scene);
  world->start();
  world->step();
  Space& space = world->space();
  constexpr int kRobots = 10'000;
  const auto place = [](int i) { return std::pair{-15.0 + 0.3 * (i % 100), -15.0 + 0.3 * (i / 100)}; };
  for (int i = 0; i < kRobots; ++i) {
    const auto [x_m, y_m] = place(i);
    ASSERT_TRUE(space.add_robot(at("r" + std::to_string(i), x_m, y_m)).ok());
  }
  EXPECT_FALSE(space.add_robot(at("one more", -15.0, -15.0)).ok());
  EXPECT_EQ(space.robot_count(), kRobots + 1U);
  EXPECT_LE(space.stores().bodies.size(), kRobots + 300U);
  world->step();
  for (int i = 0; i < kRobots; i += 1000) {
    const RobotId robot = space.find_robot("r" + std::to_string(i));
    ASSERT_TRUE(robot.valid());
    EXPECT_EQ(space.pose(robot).x_m, place(i).first);
  }
  for (int i = 0; i < kRobots; ++i) space.remove_robot(space.find_robot("r" + std::to_string(i)));
  EXPECT_EQ(space.robot_count(), 1U);
  const std::size_t rows = space.stores().bodies.size();
  for (int i = 0; i < kRobots; ++i) {  // into the rows that are free now
    const auto [x_m, y_m] = place(i);
    ASSERT_TRUE(space.add_robot(at("s" + std::to_string(i), x_m, y_m)).ok());
  }
  EXPECT_EQ(space.stores().bodies.size(), rows);
  world->step();
  EXPECT_EQ(world->state(), RunState::Running) << world->failure();
}

/// Robots with parameters that nobody else has come and go.
TEST(Robots, WithParametersOfTheirOwnLeaveTheirPlacesToOthers) {
  Scene s(4.0);
  s.robot("first", -1.5, -1.5);
  auto world = make(s);
  ASSERT_TRUE(world.world) << world.all_problems();
  world->start();
  Space& space = world->space();
  for (int i = 0; i < 3000; ++i) {
    NewRobot wanted{.id = "r" + std::to_string(i), .controller = "c", .pose = Pose::at(0, 0, 0)};
    const double speed_m_s = 1e-5 * (i + 1);
    wanted.params = {{"left", hal::format_number(speed_m_s) + " m/s"},
                     {"right", hal::format_number(speed_m_s) + " m/s"}};
    const auto robot = space.add_robot(wanted);
    ASSERT_TRUE(robot.ok()) << robot.error().message;
    world->step();
    ASSERT_DOUBLE_EQ(space.port<hal::WheelSpeeds>(robot.value())->left_m_s, speed_m_s);
    space.remove_robot(robot.value());
  }
  EXPECT_EQ(space.stores().groups.size(), 1U);
  EXPECT_LT(space.stores().bodies.size(), 50U);
  NewRobot plain{.id = "plain", .controller = "c", .pose = Pose::at(0, 0, 0)};
  const auto robot = space.add_robot(plain);
  ASSERT_TRUE(robot.ok()) << robot.error().message;
  world->step();
  EXPECT_EQ(space.port<hal::WheelSpeeds>(robot.value())->left_m_s, 0.0);
}

TEST(Robots, ComeBesideOneThatAHookPutNowhere) {
  Scene s(4.0);
  s.robot("lost", -1.5, -1.5);
  auto world = make(s);
  ASSERT_TRUE(world.world) << world.all_problems();
  world->start();
  Space& space = world->space();
  space.set_pose(space.find_robot("lost"), Pose::at(NAN, 0.0, NAN));
  EXPECT_TRUE(space.add_robot({.id = "new", .controller = "c", .pose = Pose::at(0, 0, 0)}).ok());
}

TEST_P(Runtime, AVelocityIsReadAndWhereItExistsSet) {
  auto world = make(scene("drive").param("left", "0.1").param("right", "0.1").robot("a", 0, 0, 0.5));
  world->start();
  for (int i = 0; i < 10; ++i) world->step();
  Space& space = world->space();
  const RobotId a = space.find_robot("a");
  EXPECT_NEAR(space.velocity(a).v_m_s[0], 0.1 * std::cos(0.5), 2e-3);
  EXPECT_NEAR(space.velocity(a).v_m_s[1], 0.1 * std::sin(0.5), 2e-3);
  const hal::Status set = space.set_velocity(a, {{0.01, 0.02, 0.0}, {0.0, 0.0, 0.3}});
  if (!space.stores().regions[0].listed) {
    EXPECT_THAT(error_of(set), HasSubstr("keeps no velocities"));
  } else {
    ASSERT_TRUE(set.ok()) << set.error().message;
    EXPECT_EQ(space.velocity(a).v_m_s[1], 0.02);
    EXPECT_EQ(space.velocity(a).w_rad_s[2], 0.3);
  }
  EXPECT_THAT(error_of(space.set_velocity(a, {{std::nan(""), 0, 0}, {}})), HasSubstr("not finite"));
  space.remove_robot(a);
  EXPECT_THAT(error_of(space.set_velocity(a, {})), HasSubstr("removed"));
}

TEST(Robots, ABatteryIsReadAndRefilled) {
  Scene scene(4.0, "everything");
  scene.robot("a", 0, 0);
  scene.scenario.robots[0].battery = {.full_charge = 4.0, .start_charge = 4.0, .delta = 0.4};
  auto world = make(scene);
  world->start();
  for (int i = 0; i < 5; ++i) world->step();
  Space& space = world->space();
  const RobotId a = space.find_robot("a");
  EXPECT_NEAR(space.battery(a).value(), 0.5, 1e-12);
  ASSERT_TRUE(space.set_battery(a, 1.0).ok());
  world->step();
  EXPECT_NEAR(space.port<hal::Battery>(a)->charge, 0.9F, 1e-6F);
  EXPECT_THAT(error_of(space.set_battery(a, 1.5)), HasSubstr("0 to 1"));
  // A robot like those of the file has their battery.
  const auto b = space.add_robot(at("b", 1, 1));
  ASSERT_TRUE(b.ok()) << b.error().message;
  world->step();
  EXPECT_NEAR(space.battery(b.value()).value(), 0.9, 1e-12);
  auto plain = make(Scene(4.0, "drive").robot("a", 0, 0));
  EXPECT_THAT(error_of(plain->space().battery(plain->space().find_robot("a"))), HasSubstr("takes no sensor"));
}

TEST(Robots, RegionsTakeInWhoComes) {
  Scene scene(4.0, "drive");
  scene.engine("kinematics2d", "west").side(-2, -2).side(0, -2).side(0, 2).side(-2, 2);
  auto world = make(scene.robot("a", -1, 0));
  ASSERT_TRUE(world.world) << world.all_problems();
  world->start();
  world->step();
  EXPECT_TRUE(world->space().add_robot(at("b", -0.5, 0)).ok());
  EXPECT_THAT(error_of(world->space().add_robot(at("c", 0.5, 0))), HasSubstr("in no region of an engine"));
  EXPECT_EQ(world->space().robot_count(), 2U);
}

// --- objects ---

TEST_P(Runtime, ABoxIsSeenWhenItComesAndNoMoreWhenItIsGone) {
  auto world = make(scene().robot("a", 0, 0).box(1.5, 1.5, 0.1, 0.1));
  world->start();
  world->step();
  Space& space = world->space();
  const RobotId a = space.find_robot("a");
  const auto range = static_cast<float>(hal::epuck::kind().part<hal::ProximityPart>()->range_m);
  EXPECT_FLOAT_EQ(nearest_m(space, a), range);
  const auto wall = space.add_object(box("wall", 0.09, 0, 0.02, 0.5));
  ASSERT_TRUE(wall.ok()) << wall.error().message;
  EXPECT_EQ(space.find_object("wall"), wall.value());
  world->step();
  EXPECT_LT(nearest_m(space, a), 0.05F);
  Object moved = space.objects()[wall.value().index];
  moved.x_m = 0.5;
  ASSERT_TRUE(space.set_object(wall.value(), moved).ok());
  world->step();
  EXPECT_FLOAT_EQ(nearest_m(space, a), range);
  moved.x_m = 0.09;
  ASSERT_TRUE(space.set_object(wall.value(), moved).ok());
  world->step();
  EXPECT_LT(nearest_m(space, a), 0.05F);
  space.remove_object(wall.value());
  world->step();
  EXPECT_FLOAT_EQ(nearest_m(space, a), range);
  EXPECT_FALSE(space.find_object("wall").valid());
  EXPECT_THAT(error_of(space.set_object(wall.value(), moved)), HasSubstr("removed"));
  EXPECT_THAT(error_of(space.add_object(moved)), HasSubstr("is taken, or was"));
  EXPECT_TRUE(space.find_object("box0").valid());
}

TEST_P(Runtime, ANewBoxStopsRobots) {
  auto world = make(scene("drive").param("left", "0.1").param("right", "0.1").robot("a", 0, 0));
  world->start();
  for (int i = 0; i < 5; ++i) world->step();
  ASSERT_TRUE(world->space().add_object(box("wall", 0.5, 0, 0.2, 1.0)).ok());
  for (int i = 0; i < 80; ++i) world->step();
  EXPECT_LT(world->space().pose(world->space().robot(0)).x_m, 0.4 - hal::epuck::kind().body.radius_m + 2e-3);
  world->space().remove_object(world->space().find_object("wall"));
  for (int i = 0; i < 60; ++i) world->step();
  EXPECT_GT(world->space().pose(world->space().robot(0)).x_m, 0.5);
}

// A board of 2 m by 0.4 m by 0.1 m whose base's middle is 1 m high, and which falls by 30 degrees towards x: its low
// end lies from 0.5 m up at x = 0.87 m, its high end about 1.5 m up at x = -0.87 m.
TEST(Objects, MayStandUnderAndOverABoardThatLeansButNotInIt) {
  Scene scene(8.0, "stop");
  scene.engine("dynamics3d").box(0, 0, 2.0, 0.4, 0.0, 0.1);
  scene.scenario.objects.back().placement.p_W[2] = 1.0;
  scene.scenario.objects.back().placement.pitch_rad = M_PI / 6;
  scene.cylinder(3, 3, 0.1).movable(0.1);
  auto world = make(scene);
  ASSERT_TRUE(world.world) << world.all_problems();
  world->start();
  Space& space = world->space();
  const auto crate = [](double x_m, double low_m) {
    Object o = box("crate", x_m, 0, 0.2, 0.2);
    o.movable = true;
    o.mass_kg = 1.0;
    o.z_low_m = low_m;
    o.z_high_m = low_m + 0.2;
    return o;
  };
  EXPECT_THAT(error_of(space.add_object(crate(0.7, 0.5))), HasSubstr("where box 'box0' is"));
  EXPECT_THAT(error_of(space.add_object(crate(-0.7, 1.3))), HasSubstr("where box 'box0' is"));
  const auto id = space.add_object(crate(0.7, 0.0));
  ASSERT_TRUE(id.ok()) << id.error().message;
  EXPECT_TRUE(space.room_for(id.value(), {0.7, 0.0, 1.0, 1.0, 0.0}).ok()) << "over the low end";
  EXPECT_TRUE(space.room_for(id.value(), {-0.7, 0.0, 1.0, 1.0, 0.0}).ok()) << "under the high end";
  EXPECT_FALSE(space.room_for(id.value(), {-0.7, 0.0, 1.4, 1.0, 0.0}).ok());
  EXPECT_FALSE(space.room_for(id.value(), {0.0, 0.0, 1.0, 1.0, 0.0}).ok());
  const ObjectId cylinder = space.find_object("cylinder1");
  EXPECT_FALSE(space.room_for(cylinder, {0.7, 0.0, 0.2, 1.0, 0.0}).ok()) << "0.5 m high: the board's end is 0.6 m up";
  EXPECT_TRUE(space.room_for(cylinder, {-0.7, 0.0, 0.2, 1.0, 0.0}).ok());
}

TEST_P(Runtime, SaysWhyAnObjectCannotBe) {
  auto world = make(scene("drive").robot("a", 0, 0).box(1, 0, 0.2, 0.2));
  world->start();
  world->step();
  Space& space = world->space();
  const auto error = [&](Object object) { return error_of(space.add_object(object)); };
  EXPECT_THAT(error(box("a", 1, 1, 0.1, 0.1)), HasSubstr("'a' is taken"));
  EXPECT_THAT(error(box("b", 0.05, 0, 0.1, 0.1)), HasSubstr("where robot 'a' is"));
  EXPECT_THAT(error(box("b", 1, 1, 0.0, 0.1)), HasSubstr("half_x_m"));
  EXPECT_THAT(error(box("b", std::nan(""), 1, 0.1, 0.1)), HasSubstr("finite"));
  Object crate = box("crate", -1, 0, 0.1, 0.1);
  crate.movable = true;
  crate.mass_kg = -1.0;
  EXPECT_THAT(error(crate), HasSubstr("mass above 0"));
  crate.mass_kg = 0.3;
  crate.x_m = 1.1;
  EXPECT_THAT(error(crate), HasSubstr("where box 'box0' is"));
  EXPECT_EQ(error(box("meets box0", 1.1, 0, 0.2, 0.2)), "no error");  // walls may meet
  crate.x_m = -1.0;
  if (!forces()) {
    EXPECT_THAT(error(crate), HasSubstr("no region of an engine that moves objects"));
    return;
  }
  EXPECT_EQ(error(crate), "no error");
  EXPECT_THAT(error_of(space.add_robot(at("b", -1.05, 0))), HasSubstr("where box 'crate' is"));
}

TEST_P(Runtime, AMovableBoxIsPushedThrownMadeHeavierAndFixed) {
  if (!forces()) GTEST_SKIP() << "an engine without masses";
  auto world = make(scene("drive").param("left", "0.1").param("right", "0.1").robot("a", 0, 0));
  world->start();
  world->step();
  Space& space = world->space();
  Object crate = box("crate", 0.15, 0, 0.06, 0.3);
  crate.z_high_m = 0.06;
  crate.movable = true;
  crate.mass_kg = 0.05;
  const auto id = space.add_object(crate);
  ASSERT_TRUE(id.ok()) << id.error().message;
  for (int i = 0; i < 50; ++i) world->step();
  const double pushed_m = space.objects()[id.value().index].x_m;
  EXPECT_GT(pushed_m, 0.3);
  EXPECT_GT(space.object_velocity(id.value()).v_m_s[0], 0.05);

  Object fixed = space.objects()[id.value().index];
  fixed.movable = false;
  ASSERT_TRUE(space.set_object(id.value(), fixed).ok());
  EXPECT_THAT(error_of(space.set_object_velocity(id.value(), {})), HasSubstr("not movable"));
  for (int i = 0; i < 20; ++i) world->step();
  EXPECT_EQ(space.objects()[id.value().index].x_m, fixed.x_m);
  EXPECT_LT(space.pose(space.robot(0)).x_m, fixed.x_m - 0.03 - hal::epuck::kind().body.radius_m + 2e-3);

  fixed.movable = true;
  fixed.y_m = 1.0;
  ASSERT_TRUE(space.set_object(id.value(), fixed).ok());
  ASSERT_TRUE(space.set_object_velocity(id.value(), {{0.0, 0.5, 0.0}, {}}).ok());
  world->step();
  EXPECT_GT(space.objects()[id.value().index].y_m, 1.005);  // until friction has stopped it
  space.remove_object(id.value());
  for (int i = 0; i < 5; ++i) world->step();
  EXPECT_EQ(world->state(), RunState::Running) << world->failure();
}

// --- joints ---

TEST_P(Runtime, AJointHoldsUntilItIsReleased) {
  auto world = make(scene("drive").param("left", "0.05").param("right", "0.05").robot("a", 0, 0).robot("b", -0.5, 0));
  world->start();
  world->step();
  Space& space = world->space();
  const RobotId a = space.find_robot("a");
  const double x_m = space.pose(a).x_m - 0.1;
  if (!forces()) {
    EXPECT_THAT(error_of(space.join(a, space.find_robot("b"), {x_m, 0, 0.02})), HasSubstr("has no joints"));
    return;
  }
  Object crate = box("crate", x_m, 0, 0.08, 0.08);
  crate.z_high_m = 0.06;
  crate.movable = true;
  crate.mass_kg = 0.02;
  const auto id = space.add_object(crate);
  ASSERT_TRUE(id.ok()) << id.error().message;
  const auto joint = space.join(a, id.value(), {x_m + 0.05, 0, 0.02});
  ASSERT_TRUE(joint.ok()) << joint.error().message;
  const auto gap = [&] { return space.pose(a).x_m - space.objects()[id.value().index].x_m; };
  for (int i = 0; i < 50; ++i) world->step();
  EXPECT_NEAR(gap(), 0.1, 5e-3);  // pulled along behind it
  EXPECT_GT(space.objects()[id.value().index].x_m, x_m + 0.15);
  EXPECT_TRUE(space.contains(joint.value()));
  space.release(joint.value());
  EXPECT_FALSE(space.contains(joint.value()));
  for (int i = 0; i < 30; ++i) world->step();
  EXPECT_GT(gap(), 0.2);
  const auto again = space.join(a, id.value(), {space.pose(a).x_m - 0.05, 0, 0.02}, {.kind = JointKind::Turning});
  ASSERT_TRUE(again.ok()) << again.error().message;
  EXPECT_FALSE(space.contains(joint.value()));
  world->step();
  space.remove_object(id.value());
  EXPECT_FALSE(space.contains(again.value()));
  for (int i = 0; i < 5; ++i) world->step();
  EXPECT_EQ(world->state(), RunState::Running) << world->failure();
}

TEST_P(Runtime, SaysWhyAJointCannotBe) {
  auto world = make(scene("drive").robot("a", 0, 0).robot("b", 1, 0).box(0, 1, 0.1, 0.1));
  Space& space = world->space();
  const RobotId a = space.find_robot("a");
  EXPECT_THAT(error_of(space.join(a, a, {})), HasSubstr("to itself"));
  EXPECT_THAT(error_of(space.join(a, space.find_object("box0"), {})), HasSubstr("not movable"));
  EXPECT_THAT(error_of(space.join(a, space.find_robot("nobody"), {})), HasSubstr("no such"));
  EXPECT_THAT(error_of(space.join(a, space.find_robot("b"), {std::nan(""), 0, 0})), HasSubstr("finite"));
}

// --- lamps and sounds ---

TEST(Lamps, ShineFromTheNextStepOnUntilTheyAreGone) {
  auto world = make(Scene(4.0, "everything").robot("a", 0, 0));
  world->start();
  world->step();
  Space& space = world->space();
  const RobotId a = space.find_robot("a");
  const auto brightest = [&] {
    world->step();
    const auto& port = *space.port<hal::Light>(a);
    return *std::max_element(port.level.begin(), port.level.begin() + port.count);
  };
  const auto loudest = [&] {
    world->step();
    return space.port<hal::Microphones>(a)->level[0];
  };
  const std::uint64_t dark = world->state_hash();
  EXPECT_EQ(brightest(), 0.0F);
  const auto lamp = space.add_light({"lamp", 0.5, 0, 0.2, 1.0});
  const auto horn = space.add_sound({"horn", 0.1, 0, 0.0, 1.0});
  ASSERT_TRUE(lamp.ok() && horn.ok());
  EXPECT_NE(world->state_hash(), dark);
  EXPECT_GT(brightest(), 0.5F);
  EXPECT_GT(loudest(), 0.3F);
  EXPECT_THAT(error_of(space.add_light({"horn"})), HasSubstr("taken"));
  space.remove_light(lamp.value());
  space.remove_sound(horn.value());
  EXPECT_EQ(brightest(), 0.0F);
  EXPECT_EQ(loudest(), 0.0F);
  EXPECT_FALSE(space.lights()[lamp.value()].alive);
}

// --- in a real run ---

TEST_P(Runtime, AHookThatBringsAndTakesGivesTheSameBitsForAnyThreads) {
  const auto hash_with = [&](std::int64_t threads, Assignment assignment) {
    Scene s = scene().param("left", "0.05").param("right", "0.045").implementations("noisy");
    s.walls().robots(30, 1.4);
    s.scenario.escape = EscapePolicy::Stop;
    HookConfig hook;
    hook.library = "test_hooks";
    hook.label = "shepherd";
    hook.options.name = "loop_functions";
    if (forces()) hook.options.attributes = {{"movable", "true", 0}};
    s.scenario.hooks.push_back(hook);
    WorldOptions options;
    options.threads = threads;
    options.assignment = assignment;
    auto world = make(s, options);
    EXPECT_TRUE(world.world) << world.all_problems();
    run(*world.world, 100);
    EXPECT_EQ(world->state(), RunState::Running) << world->failure();
    EXPECT_GT(world->space().stores().robots.size(), 55U);
    EXPECT_EQ(world->space().robot_count(), world->space().stores().living.size());
    return world->state_hash();
  };
  const std::uint64_t alone = hash_with(1, Assignment::Static);
  EXPECT_EQ(hash_with(3, Assignment::Static), alone);
  EXPECT_EQ(hash_with(3, Assignment::Dynamic), alone);
}

}  // namespace
}  // namespace tandem::core
