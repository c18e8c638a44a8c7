// The command as a user types it, against an emulated foot-bot; verdicts come from the robot's own log.
#include <gmock/gmock.h>

#include "tests/checkout.hpp"
#include "tests/scenarios/process.hpp"

namespace tandem::scenarios {
namespace {

using testing::HasSubstr;

const std::string kConfigs = std::string(test::kSourceDir) + "/configs/";
constexpr int kCruise = 12;  // 5 cm/s in pulses per 5 ms

std::vector<std::string> drive(const EmulatedFootbot& footbot, std::vector<std::string> more = {}) {
  std::vector<std::string> arguments = {"robot", kConfigs + "footbot_robot.xml", "--link", footbot.link()};
  arguments.insert(arguments.end(), more.begin(), more.end());
  return arguments;
}

bool says(const Tandem& program, const std::string& text) {
  return eventually([&] { return program.errors().find(text) != std::string::npos; }, 20.0);
}

/// When the line of the log that contains `text` for the last time was written.
long long time_of_last(const std::string& log, const std::string& text) {
  const std::size_t at = log.rfind(text);
  if (at == std::string::npos) return -1;
  return std::stoll(json_value(log, "t_ns", log.rfind('\n', at) + 1));
}

struct Door {
  std::string link;
  std::string firmware;
};

class ThroughEveryDoor : public testing::TestWithParam<Door> {};

TEST_P(ThroughEveryDoor, AFootbotIsDriven) {
  Folder folder;
  EmulatedFootbot footbot(folder, {"--firmware", GetParam().firmware}, GetParam().link);
  ASSERT_TRUE(footbot.ready());
  Tandem robot(drive(footbot, {"--seconds", "2", "--report", "r.json"}), folder.path());
  ASSERT_EQ(robot.wait(), 0) << robot.errors();
  const std::string report = text_of(folder.path() / "r.json");
  EXPECT_EQ(json_value(report, "state"), "active") << report;
  EXPECT_EQ(json_value(report, "interruptions"), "0") << report;
  EXPECT_EQ(json_value(report, "not_understood"), "0") << report;
  int fastest = 0;
  for (const auto& w : footbot.wheels()) {
    EXPECT_EQ(std::abs(w.left - w.right) <= kCruise, true) << "straight on, one motor after the other";
    fastest = std::max(fastest, w.left);
  }
  EXPECT_EQ(fastest, kCruise);
  EXPECT_FALSE(footbot.moves());
  EXPECT_EQ(footbot.end(), 0);
  EXPECT_THAT(footbot.log(), HasSubstr(R"("why":"stopped","left":0,"right":0)"));
}

INSTANTIATE_TEST_SUITE_P(Doors, ThroughEveryDoor,
                         testing::Values(Door{"pty:fb0", "v4"}, Door{"pty:fb0", "v5"},
                                         Door{"tcp-listen:127.0.0.1:0", "v4"}, Door{"tcp-listen:127.0.0.1:0", "v5"}));

class EmulatedFootbotEndsStopped : public testing::TestWithParam<int> {};

TEST_P(EmulatedFootbotEndsStopped, OnSignals) {
  Folder folder;
  EmulatedFootbot footbot(folder);
  ASSERT_TRUE(footbot.ready());
  Tandem robot(drive(footbot), folder.path());
  ASSERT_TRUE(eventually([&] { return footbot.moves(); }, 20.0)) << robot.errors();
  robot.signal(GetParam());
  const bool killed = GetParam() == SIGKILL;
  EXPECT_EQ(robot.wait(), killed ? -SIGKILL : 128 + GetParam()) << robot.errors();
  EXPECT_TRUE(eventually([&] { return !footbot.moves(); }, killed ? 10.0 : 0.0)) << footbot.log();
}

INSTANTIATE_TEST_SUITE_P(Signals, EmulatedFootbotEndsStopped, testing::Values(SIGINT, SIGTERM, SIGKILL));

TEST(EmulatedFootbot, IsStoppedByAControllerThatThrows) {
  Folder folder;
  EmulatedFootbot footbot(folder);
  ASSERT_TRUE(footbot.ready());
  folder.write("thrower.xml",
               R"(<tandem><framework><experiment length="0" ticks_per_second="10"/></framework><controllers>
<thrower id="t" library="test_controllers"><actuators><differential_steering/></actuators></thrower></controllers>
<arena size="2,2,1"><foot-bot id="fb0"><body position="0,0,0"/><controller config="t"/><bridge link="slcan:fb0@1000000" map=")" +
                   kConfigs + R"(footbot_map.xml"/></foot-bot></arena></tandem>)");
  Tandem robot({"robot", "thrower.xml"}, folder.path());
  EXPECT_EQ(robot.wait(), 3);
  EXPECT_THAT(robot.errors(), HasSubstr("'fb0' threw at tick 3: lost my way"));
  EXPECT_TRUE(footbot.has_moved());
  EXPECT_FALSE(footbot.moves());
}

TEST(EmulatedFootbot, IsStoppedAfterALinkLossBeforeItDrivesOn) {
  Folder folder;
  const std::string fault = "hangup@drive+2s+1s";
  EmulatedFootbot footbot(folder, {"--fault", fault});
  ASSERT_TRUE(footbot.ready());
  Tandem robot(drive(footbot), folder.path());
  ASSERT_TRUE(eventually([&] { return footbot.moves(); }, 20.0)) << robot.errors();
  ASSERT_TRUE(eventually([&] { return footbot.fault_ns(fault, "end") > 0; }, 20.0));
  const long long back_ns = footbot.fault_ns(fault, "end");
  const auto since = [&] {
    std::vector<EmulatedFootbot::Wheels> all;
    for (const auto& w : footbot.wheels()) {
      if (w.t_ns >= back_ns) all.push_back(w);
    }
    return all;
  };
  const auto rests = [](const EmulatedFootbot::Wheels& w) { return w.left == 0 && w.right == 0; };
  const auto stood = [&] {
    const auto all = since();
    return std::any_of(all.begin(), all.end(), rests);
  };
  ASSERT_TRUE(eventually(stood, 20.0)) << robot.errors();
  // One motor is stopped, perhaps more than once, and then the other; nothing drives before that.
  for (const auto& w : since()) {
    if (rests(w)) break;
    EXPECT_TRUE(w.left == 0 || w.right == 0) << footbot.log();
  }
  // A robot that can be reached again stands within a second, of which its program had the processor.
  const auto all = since();
  const long long stood_ns = std::find_if(all.begin(), all.end(), rests)->t_ns;
  EXPECT_LE(stood_ns - back_ns, 1'000'000'000 + footbot.late_ns(back_ns, stood_ns)) << footbot.log();
  EXPECT_TRUE(waits_for_a_person(robot, [&] { return footbot.moves(); })) << footbot.log();
  robot.signal(SIGINT);
  EXPECT_EQ(robot.wait(), 130) << robot.errors();
  EXPECT_FALSE(footbot.moves());
}

TEST(EmulatedFootbot, IsFoundAgainWhenAMotorsModuleRestarts) {
  Folder folder;
  EmulatedFootbot footbot(folder, {"--fault", "restart=left-motor@drive+2s"});
  ASSERT_TRUE(footbot.ready());
  Tandem robot(drive(footbot, {"--report", "r.json"}), folder.path());
  ASSERT_TRUE(eventually([&] { return footbot.moves(); }, 20.0)) << robot.errors();
  const std::string restart = R"("by":"fault")";
  ASSERT_TRUE(eventually([&] { return footbot.log().find(restart) != std::string::npos; }, 20.0));
  const long long at_ns = time_of_last(footbot.log(), restart);
  // It may be told to drive once more before the hub has seen that it restarted.
  EXPECT_TRUE(says(robot, "its node 'left motor' restarted")) << robot.errors() << footbot.log();
  EXPECT_TRUE(says(robot, "robot stopped by itself")) << robot.errors();
  EXPECT_TRUE(waits_for_a_person(robot, [&] {
    const auto all = footbot.wheels();
    return !all.empty() && all.back().t_ns > at_ns && all.back().left == kCruise && all.back().right == kCruise;
  })) << footbot.log();
  robot.signal(SIGTERM);
  EXPECT_EQ(robot.wait(), 143) << robot.errors();
  EXPECT_FALSE(footbot.moves());
  EXPECT_EQ(json_value(text_of(folder.path() / "r.json"), "restarts"), "1");
}

TEST(EmulatedFootbot, WaitsForAModuleThatComesLate) {
  Folder folder;
  EmulatedFootbot footbot(folder, {"--fault", "missing=proximity-sensors@0s+4s"});
  ASSERT_TRUE(footbot.ready());
  Tandem robot(drive(footbot), folder.path());
  ASSERT_TRUE(eventually([&] { return footbot.moves(); }, 20.0)) << robot.errors();
  const long long there_ns = time_of_last(footbot.log(), R"("event":"boot","module":"proximity sensors")");
  for (const auto& w : footbot.wheels()) {
    if (w.left != 0 || w.right != 0) {
      EXPECT_GT(w.t_ns, there_ns) << "not before it sees";
    }
  }
  robot.signal(SIGINT);
  EXPECT_EQ(robot.wait(), 130) << robot.errors();
  EXPECT_FALSE(footbot.moves());
}

/// A foot-bot with one fault and who tries to drive it.
struct Attempt {
  explicit Attempt(const std::string& fault)
      : footbot(folder, {"--fault", fault}), robot(drive(footbot), folder.path()) {}
  Folder folder;
  EmulatedFootbot footbot;
  Tandem robot;
};

TEST(EmulatedFootbot, IsNotDrivenWhenAModuleLies) {
  Attempt size("lie=left-motor:size");
  Attempt name("lie=left-motor:name");
  Attempt count("lie=right-motor:count");
  for (Attempt* a : {&size, &name, &count}) {
    EXPECT_EQ(a->robot.wait(60), 3) << a->robot.errors();
    EXPECT_FALSE(a->footbot.has_moved());
  }
  EXPECT_THAT(size.robot.errors(), HasSubstr("variable 'speed' has 2 words"));
  EXPECT_THAT(name.robot.errors(), HasSubstr("node 'left motor': has no variable 'speed'"));
  EXPECT_THAT(count.robot.errors(), HasSubstr("'right motor' describes itself as it cannot be"));
}

TEST(EmulatedFootbot, SurvivesABadBus) {
  Folder folder;
  EmulatedFootbot footbot(folder, {"--fault", "drop=0.01", "--fault", "lose=0.01", "--fault", "double=0.01", "--fault",
                                   "swap=0.01", "--fault", "silent=left-motor@drive+3s+400ms"});
  ASSERT_TRUE(footbot.ready());
  Tandem robot(drive(footbot), folder.path());
  ASSERT_TRUE(eventually([&] { return footbot.fault_ns("silent=left-motor@drive+3s+400ms", "end") > 0; }, 40.0))
      << robot.errors();
  EXPECT_TRUE(eventually([&] { return footbot.moves(); }, 20.0)) << robot.errors();
  robot.signal(SIGINT);
  EXPECT_EQ(robot.wait(60), 130) << robot.errors();
  for (const auto& w : footbot.wheels()) {
    EXPECT_LE(std::abs(w.left), kCruise);
    EXPECT_LE(std::abs(w.right), kCruise);
  }
  EXPECT_FALSE(footbot.moves()) << footbot.log();
}

TEST(EmulatedFootbot, IsInspectedAndNothingMoves) {
  Folder folder;
  EmulatedFootbot footbot(folder);
  ASSERT_TRUE(footbot.ready());
  Tandem inspect({"inspect", footbot.link()}, folder.path());
  EXPECT_EQ(inspect.wait(), 0) << inspect.errors();
  for (const char* module : {"left motor", "proximity sensors", "range and bearing", "base"}) {
    EXPECT_THAT(inspect.output(), HasSubstr(std::string("'") + module + "', ready, protocol 4"));
  }
  EXPECT_TRUE(footbot.wheels().empty());
}

TEST(EmulatedFootbot, IsInspectedUntilEveryModuleHasDescribedItself) {
  Folder folder;
  EmulatedFootbot footbot(folder, {"--fault", "drop=0.02", "--fault", "lie=gripper:count"});
  ASSERT_TRUE(footbot.ready());
  Tandem inspect({"inspect", footbot.link()}, folder.path());
  EXPECT_EQ(inspect.wait(60), 0) << inspect.errors();
  const std::string text = inspect.output();
  std::size_t at = 0;
  for (int id = 1; id <= 9; ++id) {  // by number
    const std::string line = id == 6 ? "node 6 did not describe itself" : "node " + std::to_string(id) + " '";
    at = text.find(line, at);
    ASSERT_NE(at, std::string::npos) << line << "\n" << text;
  }
}

TEST(EmulatedFootbot, MayLiveInASimulatedArena) {
  Folder folder;
  folder.write(
      "arena.xml",
      R"(<tandem><framework><experiment length="0" ticks_per_second="10" random_seed="1"/></framework><controllers>
<footbot_puppet id="p" library="puppet"><actuators><differential_steering/></actuators><sensors><footbot_proximity/></sensors>
</footbot_puppet></controllers><arena size="3,3,1"><box id="wall" size="0.1,3,0.5" movable="false"><body position="0.45,0,0"/></box>
<foot-bot id="body"><body position="0,0,0"/><controller config="p"/></foot-bot></arena>
<physics_engines><kinematics2d id="k"/></physics_engines></tandem>)");
  EmulatedFootbot footbot(folder, {"--arena", "arena.xml", "--body", "body"});
  ASSERT_TRUE(footbot.ready());
  // The wall is 31.5 cm ahead of the rim: soon the robot sees it and turns away.
  Tandem robot(drive(footbot), folder.path());
  const auto turns = [&] {
    for (const auto& w : footbot.wheels()) {
      if (w.left == -kCruise && w.right == kCruise) return true;
      if (w.left == kCruise && w.right == -kCruise) return true;
    }
    return false;
  };
  EXPECT_TRUE(eventually(turns, 30.0)) << robot.errors();
  robot.signal(SIGINT);
  EXPECT_EQ(robot.wait(), 130) << robot.errors();
  EXPECT_FALSE(footbot.moves());

  Tandem nobody({"emulate", "footbot", "--link", "pty:x", "--arena", "arena.xml", "--body", "wall"}, folder.path());
  EXPECT_EQ(nobody.wait(), 1);
  EXPECT_THAT(nobody.errors(), HasSubstr("no robot 'wall'"));
}

}  // namespace
}  // namespace tandem::scenarios
