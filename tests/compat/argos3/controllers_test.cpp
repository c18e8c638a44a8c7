// Controllers for ARGoS in worlds: their life, their parameters, what they throw, what chance gives them.
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "compat/argos3/control/controller_types.hpp"
#include "compat/argos3/simulator/hooks.hpp"
#include "tests/compat/argos3/world.hpp"

namespace tandem::test {
namespace {

using ::testing::AllOf;
using ::testing::HasSubstr;
using ::testing::Not;

TEST(ArgosControllers, AreInitialisedOnceThenResetThenDestroyed) {
  std::string said;
  {
    ArgosWorld world({.label = "life", .robots = 2});
    world.run(2);
    ASSERT_TRUE(world.world->reset(5).ok());
    world.run(1);
    world.world.reset();
    said = world.said;
  }
  EXPECT_THAT(said, AllOf(HasSubstr("robot 'r0' at tick 0: [r0] Init"), HasSubstr("[r1] Init"),
                          HasSubstr("[r0] step 2"), HasSubstr("[r1] Reset after 2")));
  EXPECT_THAT(said, HasSubstr("[r0] Destroy after 1")) << "a line that has not ended is told, too";
  std::size_t inits = 0;
  for (std::size_t at = said.find("Init"); at != std::string::npos; at = said.find("Init", at + 1)) ++inits;
  EXPECT_EQ(inits, 2U);
}

TEST(ArgosControllers, AreNotCopied) {
  ArgosWorld world({.label = "life"});
  ASSERT_NE(world.world, nullptr) << world.problems;
  EXPECT_EQ(argos_catalog().find<hal::ControllerType>("life"), nullptr) << "the library's, not the program's";
}

struct Thrown {
  const char *when, *what, *text;
};
class ArgosExceptions : public testing::TestWithParam<Thrown> {};
INSTANTIATE_TEST_SUITE_P(Of, ArgosExceptions,
                         testing::Values(Thrown{"init", "argos", "the outer reason in init\nthe inner reason"},
                                         Thrown{"init", "std", "a standard one in init"},
                                         Thrown{"step", "argos", "the outer reason in step\nthe inner reason"},
                                         Thrown{"step", "std", "a standard one in step"},
                                         Thrown{"step", "int", "an exception of unknown type"}),
                         [](const auto& one) { return std::string(one.param.when) + one.param.what; });

TEST_P(ArgosExceptions, AreToldWithTheRobot) {
  const Thrown& thrown = GetParam();
  ArgosWorld world({.label = "thrower",
                    .params = std::string("<params when=\"") + thrown.when + "\" what=\"" + thrown.what + "\"/>"});
  const std::string told = world.incident();
  EXPECT_THAT(told, AllOf(HasSubstr("r0"), HasSubstr(thrown.text)));
}

TEST(ArgosControllers, ThatThrowAtTheEndAreTold) {
  ArgosWorld world({.label = "thrower", .params = "<params when=\"destroy\" what=\"argos\"/>"});
  world.run(1);
  world.world.reset();
  EXPECT_THAT(world.said, HasSubstr("in Destroy(): the outer reason in destroy"));
  ArgosWorld other({.label = "thrower", .params = "<params when=\"destroy\" what=\"int\"/>"});
  other.run(1);
  other.world.reset();
  EXPECT_THAT(other.said, HasSubstr("in Destroy(): an exception of unknown type"));
}

constexpr const char* kNested =
    R"(<wheel_turning real="1.5" angle="90" range="-0.1:0.2" vector="1,2,3" turn="90,0,0" color="red" byte="200"
flag="true"/><item name="a"/><item name="b &amp; &quot;c&quot;"/>)";

TEST(ArgosParameters, AreReadFromNestedElements) {
  ArgosWorld world({.label = "parameters", .params = std::string("<params>") + kNested + "</params>"});
  world.run(1);
  EXPECT_THAT(world.said, HasSubstr("1.5 CDegrees(90) -0.1:0.2 1,2,3 90,0,0 red 200 true"));
  EXPECT_THAT(world.said, HasSubstr("a;b & \"c\"; 10"));
}

TEST(ArgosParameters, ThatAreNoSuchValueAreAnErrorWithTheirName) {
  ArgosWorld world(
      {.label = "parameters", .params = std::string("<params>") + kNested + "<wrong number=\"many\"/></params>"});
  EXPECT_THAT(world.incident(), AllOf(HasSubstr("the attribute 'number' of <wrong> cannot be read"),
                                      HasSubstr("'many' cannot be converted")));
  ArgosWorld none({.label = "parameters"});
  EXPECT_THAT(none.incident(), HasSubstr("<params> has no child <wheel_turning>"));
}

TEST(ArgosDevices, ThatAreNotListedAreAnError) {
  ArgosWorld none({.label = "asking", .sensors = "<light/>", .params = "<params name=\"lihgt\"/>"});
  EXPECT_THAT(none.incident(), AllOf(HasSubstr("asks for the sensor 'lihgt'"), HasSubstr("it lists: light"),
                                     HasSubstr("Did you mean 'light'?"), HasSubstr("r0")));
  ArgosWorld other({.label = "asking", .sensors = "<proximity/>", .params = "<params name=\"proximity\"/>"});
  EXPECT_THAT(other.incident(), HasSubstr("the sensor 'proximity' is no argos::CCI_LightSensor"));
  ArgosWorld good({.label = "asking", .sensors = "<light/>", .params = "<params name=\"light\"/>"});
  good.run(1);
  EXPECT_THAT(good.said, HasSubstr("has 1"));
}

TEST(ArgosDevices, ThatTheLayerHasNoClassForAreNamed) {
  ArgosWorld world({.label = "asking", .sensors = "<accelerometer/>", .params = "<params name=\"accelerometer\"/>"});
  EXPECT_THAT(world.incident(),
              AllOf(HasSubstr("lists the sensor 'accelerometer'"), HasSubstr("no class for it (port accelerometer)")));
}

TEST(ArgosClasses, AreForgottenWithTheirLibraries) {
  namespace compat = tandem::compat::argos3;
  hal::Catalog catalog;
  for (int i = 0; i < 600; ++i) {
    for (const char* kind : {"controller", "loop functions", "user functions"}) {
      const std::string label = kind[0] + std::to_string(i);
      auto one = std::make_unique<argos::tandem_detail::SRegistration>(
          argos::tandem_detail::SRegistration{kind, label.c_str(), "CLoop", nullptr, nullptr});
      argos::tandem_detail::Register(*one);
      const hal::Status good = catalog.add_from(label, [&](hal::Registrar& registrar) {
        compat::register_controllers({one.get()}, registrar);
        compat::register_hooks({one.get()}, registrar);
      });
      EXPECT_TRUE(good.ok()) << good.error().message;
      argos::tandem_detail::Unregister(*one);
    }
  }
}

TEST(ArgosChance, IsARobotsOwnWhateverTheThreadsAndTheOthers) {
  ArgosWorld one({.label = "chance", .robots = 40}), four({.label = "chance", .robots = 40, .threads = 4});
  ArgosWorld few({.label = "chance", .robots = 3});
  one.run(1);
  four.run(1);
  few.run(1);
  for (int i = 0; i < 3; ++i) {
    const std::string robot = "robot 'r" + std::to_string(i) + "' at tick 0: ";
    const auto drawn = [&](const std::string& said) {
      const std::size_t at = said.find(robot);
      EXPECT_NE(at, std::string::npos) << said;
      return at == std::string::npos ? "" : said.substr(at, said.find('\n', at) - at);
    };
    EXPECT_EQ(drawn(one.said), drawn(four.said));
    EXPECT_EQ(drawn(one.said), drawn(few.said));
    if (i == 0) continue;
    const auto drawn_by_first = one.said.substr(one.said.find("robot 'r0'") + robot.size(), 20);
    EXPECT_EQ(drawn(one.said).find(drawn_by_first), std::string::npos) << "each has its own";
  }
}

TEST(ArgosChance, IsTheSameWhenTheRunBeginsAnewWithItsSeed) {
  ArgosWorld world({.label = "chance"});
  ASSERT_TRUE(world.world->reset(7).ok());
  world.said.clear();
  world.run(1);
  const std::string first = world.said;
  ASSERT_TRUE(world.world->reset(7).ok());
  world.said.clear();
  world.run(1);
  EXPECT_EQ(world.said, first);
  ASSERT_TRUE(world.world->reset(8).ok());
  world.said.clear();
  world.run(1);
  EXPECT_NE(world.said, first);
}

class ArgosWalkers : public testing::TestWithParam<std::string> {};
INSTANTIATE_TEST_SUITE_P(In, ArgosWalkers, testing::Values("kinematics2d", "dynamics2d", "dynamics3d", "particle3d"),
                         [](const auto& one) { return one.param; });

TEST_P(ArgosWalkers, WalkInEveryEngineWithTheSameBits) {
  for (const bool epuck : {true, false}) {
    Argos setting{.label = epuck ? "epuck_walker" : "footbot_walker",
                  .robot = epuck ? "e-puck" : "foot-bot",
                  .sensors = epuck ? "<epuck_proximity/>" : "<footbot_proximity/>",
                  .params = "<params velocity=\"10\"/>",
                  .engine = GetParam(),
                  .robots = 6,
                  .apart_m = 0.3};
    ArgosWorld one(setting);
    setting.threads = 3;
    ArgosWorld three(setting);
    one.run(50);
    three.run(50);
    EXPECT_EQ(one.world->state_hash(), three.world->state_hash());
    double way_m = 0.0;
    for (std::size_t i = 0; i < 6; ++i) {
      const auto& space = one.world->space();
      const auto pose = space.pose(space.robot(i));
      way_m += std::hypot(pose.x_m - 0.3 * static_cast<double>(i), pose.y_m);
    }
    EXPECT_GT(way_m, 0.3) << "they moved";
  }
}

}  // namespace
}  // namespace tandem::test
