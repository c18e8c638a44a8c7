// What people do to a running simulation, and what they are told when it cannot be done.
#include "core/live/touch.hpp"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "tests/core/live/held.hpp"

namespace tandem::core {
namespace {

using hal::Json;
using testing::AllOf;
using testing::HasSubstr;
using testing::Not;

class Touches : public testing::Test {
 protected:
  Touches() {
    Scene scene(4.0, "drive");
    scene.engine("dynamics2d").walls().robot("a", 0, 0).robot("b", 1, 0).box(0, 1, 0.2, 0.2).movable(0.2);
    LightItem lamp;
    lamp.id = "lamp";
    lamp.p_W = {0.5, 0.5, 1.0};
    scene.scenario.lights.push_back(lamp);
    made = make(scene);
    if (made.world == nullptr) throw std::runtime_error(made.all_problems());
    world().start();
    world().step();
  }
  World& world() { return *made.world; }
  std::string error_of(Json command) {
    const auto done = touch(world(), command);
    return done.ok() ? "" : done.error().message;
  }
  Pose pose(const std::string& robot) { return world().space().pose(world().space().find_robot(robot)); }

  MadeWorld made;
};

TEST_F(Touches, MoveAndTurnRobots) {
  EXPECT_EQ(error_of({{"do", "move"}, {"robot", "a"}, {"x", -1.0}, {"y", 0.5}, {"heading", 1.5}}), "");
  EXPECT_DOUBLE_EQ(pose("a").x_m, -1.0);
  EXPECT_DOUBLE_EQ(pose("a").heading_rad(), 1.5);
  EXPECT_EQ(error_of({{"do", "move"}, {"robot", "a"}, {"heading", -1.0}}), "");
  EXPECT_DOUBLE_EQ(pose("a").x_m, -1.0);
  for (int i = 0; i < 10; ++i) world().step();
  EXPECT_NEAR(pose("a").x_m, -1.0, 1e-6);
}

TEST_F(Touches, AreRefusedWhereSomethingIsInTheWay) {
  const std::uint64_t before = world().state_hash();
  EXPECT_THAT(error_of({{"do", "move"}, {"robot", "a"}, {"x", 1.93}}),
              HasSubstr("robot 'a' would be at (1.93, 0), where box"));
  EXPECT_THAT(error_of({{"do", "move"}, {"robot", "a"}, {"x", 1.01}}), HasSubstr("where robot 'b' is"));
  EXPECT_THAT(error_of({{"do", "move"}, {"robot", "a"}, {"y", 1.05}}), HasSubstr("where box 'box4' is"));
  EXPECT_THAT(error_of({{"do", "move"}, {"robot", "a"}, {"x", 7}}), HasSubstr("outside the arena"));
  EXPECT_THAT(error_of({{"do", "move"}, {"object", "box4"}, {"x", 1.0}, {"y", 0.0}}), HasSubstr("where robot 'b' is"));
  EXPECT_THAT(error_of({{"do", "move"}, {"object", "box0"}, {"x", 0.0}, {"y", 0.0}}), HasSubstr("where robot 'a' is"));
  EXPECT_THAT(error_of({{"do", "add"}, {"robot", {{"x", 1.0}, {"y", 0.01}}}}), HasSubstr("where robot 'b' is"));
  EXPECT_EQ(world().state_hash(), before);
}

TEST_F(Touches, MoveObjectsAndLamps) {
  EXPECT_EQ(error_of({{"do", "move"}, {"object", "box4"}, {"x", -0.5}, {"y", -0.5}, {"heading", 0.7}}), "");
  const Object& box = world().space().objects()[4];
  EXPECT_DOUBLE_EQ(box.x_m, -0.5);
  EXPECT_DOUBLE_EQ(box.sin_h, std::sin(0.7));
  EXPECT_DOUBLE_EQ(box.z_high_m, 0.5);
  EXPECT_EQ(error_of({{"do", "move"}, {"light", "lamp"}, {"z", 2.0}}), "");
  EXPECT_DOUBLE_EQ(world().space().lights()[0].z_m, 2.0);
  EXPECT_DOUBLE_EQ(world().space().lights()[0].x_m, 0.5);
}

TEST_F(Touches, AddAndRemove) {
  Json robot{{"do", "add"}, {"robot", {{"x", -1.0}, {"y", -1.0}, {"heading", 0.5}}}};
  const auto added = touch(world(), robot);
  ASSERT_TRUE(added.ok()) << added.error().message;
  EXPECT_EQ(added.value()["added"], "added1");
  EXPECT_EQ(robot["robot"]["id"], "added1");  // to be repeated under this name
  EXPECT_EQ(error_of({{"do", "add"},
                      {"object", {{"shape", "cylinder"}, {"x", 1.0}, {"y", 1.0}, {"radius", 0.1}, {"height", 0.2}}}}),
            "");
  EXPECT_EQ(world().space().objects().back().id, "added2");
  EXPECT_EQ(error_of({{"do", "add"}, {"light", {{"id", "sun"}, {"x", 0}, {"y", 0}, {"z", 1}, {"color", "#ff8000"}}}}),
            "");
  EXPECT_EQ(world().space().lights().back().color, (hal::Rgb{255, 128, 0}));
  world().step();
  EXPECT_EQ(error_of({{"do", "remove"}, {"robot", "added1"}}), "");
  EXPECT_EQ(error_of({{"do", "remove"}, {"object", "added2"}}), "");
  EXPECT_EQ(error_of({{"do", "remove"}, {"light", "sun"}}), "");
  EXPECT_EQ(world().space().robot_count(), 2U);
  EXPECT_THAT(error_of({{"do", "remove"}, {"robot", "added1"}}), HasSubstr("no robot 'added1', or no more"));
  EXPECT_THAT(error_of({{"do", "move"}, {"light", "sun"}}), HasSubstr("no lamp 'sun'"));
  EXPECT_THAT(error_of({{"do", "add"}, {"robot", {{"id", "added1"}, {"x", 0.5}, {"y", 0.0}}}}),
              HasSubstr("is taken, or was"));
  EXPECT_THAT(error_of({{"do", "add"}, {"robot", {{"controller", "d"}, {"x", 0.5}, {"y", 0.0}}}}),
              HasSubstr("no controller with id 'd'"));
}

TEST_F(Touches, SwitchLampsAndHoldRobots) {
  EXPECT_EQ(error_of({{"do", "light"}, {"light", "lamp"}, {"intensity", 0.0}}), "");
  EXPECT_EQ(world().space().lights()[0].intensity, 0.0);
  EXPECT_EQ(error_of({{"do", "halt"}, {"robot", "*"}}), "");
  const RobotId a = world().space().find_robot("a");
  EXPECT_TRUE(world().space().halted_by(a, HaltOwner::Operator));
  world().space().set_halted(a, true, HaltOwner::Hook);
  Json release{{"do", "release"}, {"robot", "a"}};
  const auto released = touch(world(), release);
  ASSERT_TRUE(released.ok());
  EXPECT_EQ(released.value()["note"], "a hook holds the robot, too: it stands until that lets go");
  EXPECT_FALSE(world().space().halted_by(a, HaltOwner::Operator));
}

TEST_F(Touches, WhoLetsGoIsToldWhetherTheRobotStandsOnOrMayDriveAtOnce) {
  const RobotId a = world().space().find_robot("a");
  const auto told_with = [&](HaltOwner other) {
    world().space().set_halted(a, true, HaltOwner::Operator);
    world().space().set_halted(a, true, other);
    Json release{{"do", "release"}, {"robot", "a"}};
    const auto released = touch(world(), release);
    world().space().set_halted(a, false, other);
    return released.ok() ? released.value().value("note", "") : released.error().message;
  };
  EXPECT_THAT(told_with(HaltOwner::Controller), HasSubstr("stands until the run is over"));
  EXPECT_THAT(told_with(HaltOwner::Hook), HasSubstr("stands until"));
  EXPECT_THAT(told_with(HaltOwner::Safety), AllOf(HasSubstr("it drives when"), Not(HasSubstr("stands"))))
      << "its table held it because the person did";
}

TEST_F(Touches, ThatMakeNoSenseChangeNothing) {
  const std::uint64_t before = world().state_hash();
  for (const Json& command :
       {Json::object(),
        Json{{"do", "move"}},
        Json{{"do", "move"}, {"robot", 3}},
        Json{{"do", "move"}, {"robot", "a"}, {"x", "left"}},
        Json{{"do", "move"}, {"robot", "a"}, {"x", 1e12}},
        Json{{"do", "move"}, {"robot", "a"}, {"heading", nullptr}},
        Json{{"do", "add"}},
        Json{{"do", "add"}, {"robot", 1}},
        Json{{"do", "add"}, {"robot", {{"x", 0.5}, {"y", 0}, {"id", "a\nb"}}}},
        Json{{"do", "add"}, {"robot", {{"x", 0.5}, {"y", 0}, {"id", std::string(65, 'a')}}}},
        Json{{"do", "add"}, {"robot", {{"x", 1}}}},
        Json{{"do", "add"}, {"object", {{"shape", "cone"}}}},
        Json{{"do", "add"}, {"object", {{"shape", "box"}, {"x", 1}, {"y", 1}, {"height", 1}}}},
        Json{{"do", "add"},
             {"object", {{"shape", "box"}, {"x", 1}, {"y", 1}, {"height", 1}, {"size_x", -1}, {"size_y", 1}}}},
        Json{{"do", "add"}, {"light", {{"x", 1}, {"y", 1}, {"z", 1}, {"color", "red"}}}},
        Json{{"do", "light"}, {"light", "lamp"}, {"intensity", -1}},
        Json{{"do", "halt"}},
        Json{{"do", "set"}, {"owner", "hook:none"}, {"control", "x"}, {"value", 1}},
        Json{{"do", "set"}, {"owner", 1}},
        Json{{"do", "press"}, {"owner", "robot:z"}, {"control", "x"}}}) {
    EXPECT_NE(error_of(command), "") << hal::to_text(command);
  }
  EXPECT_EQ(world().state_hash(), before);
}

TEST(Drags, AreOneAction) {
  const Json first{{"do", "move"}, {"robot", "a"}, {"x", 1}, {"y", 2}};
  EXPECT_TRUE(continues(first, {{"do", "move"}, {"robot", "a"}, {"x", 1.1}, {"y", 2}, {"heading", 1}}));
  EXPECT_FALSE(continues(first, {{"do", "move"}, {"robot", "a"}, {"heading", 1}}));  // would lose the place
  EXPECT_FALSE(continues(first, {{"do", "move"}, {"robot", "b"}, {"x", 1}, {"y", 2}}));
  EXPECT_FALSE(continues(first, {{"do", "remove"}, {"robot", "a"}}));
}

}  // namespace
}  // namespace tandem::core
