// The command as a user types it, against a foot-bot whose modules sit behind a TCP port of this test.
#include <algorithm>
#include <gmock/gmock.h>

#include "tests/bridges/footbot/footbot_on_tcp.hpp"
#include "tests/checkout.hpp"
#include "tests/scenarios/process.hpp"

namespace tandem::scenarios {
namespace {

using bridges::footbot::FootbotOnTcp;
using testing::HasSubstr;

const std::string kConfigs = std::string(test::kSourceDir) + "/configs/";

TEST(RealFootbot, IsDrivenByTheControllerOfTheSimulatedOnes) {
  Folder folder;
  FootbotOnTcp footbot;
  Tandem robot(
      {"robot", kConfigs + "footbot_robot.xml", "--link", footbot.link, "--seconds", "2", "--report", "r.json"},
      folder.path());
  EXPECT_TRUE(eventually([&] { return footbot.moves(); }, 20.0));
  // 5 cm/s with nothing in sight, when the ramp is over.
  const auto ahead = [&] {
    return footbot.with([](auto& m) { return static_cast<int>(m.word("left motor", "speed")); });
  };
  EXPECT_TRUE(eventually([&] { return ahead() == 12; }, 20.0)) << ahead();
  ASSERT_EQ(robot.wait(), 0) << robot.errors();
  EXPECT_FALSE(footbot.moves());
  const std::string report = text_of(folder.path() / "r.json");
  EXPECT_EQ(json_value(report, "state"), "active") << report;
  EXPECT_EQ(json_value(report, "steps"), "20");
  EXPECT_THAT(report, HasSubstr("\"proximity sensors\""));
}

class FootbotEndsStopped : public testing::TestWithParam<int> {};

TEST_P(FootbotEndsStopped, OnSignals) {
  Folder folder;
  FootbotOnTcp footbot;
  Tandem robot({"robot", kConfigs + "footbot_robot.xml", "--link", footbot.link}, folder.path());
  ASSERT_TRUE(eventually([&] { return footbot.moves(); }, 20.0)) << robot.errors();
  robot.signal(GetParam());
  EXPECT_EQ(robot.wait(), GetParam() == SIGKILL ? -SIGKILL : 128 + GetParam()) << robot.errors();
  EXPECT_TRUE(eventually([&] { return !footbot.moves(); }, GetParam() == SIGKILL ? 10.0 : 0.0));
}

INSTANTIATE_TEST_SUITE_P(Signals, FootbotEndsStopped, testing::Values(SIGINT, SIGTERM, SIGKILL));

TEST(RealFootbot, IsFoundAgainWhenTheConnectionBreaks) {
  Folder folder;
  FootbotOnTcp footbot;
  Tandem robot({"robot", kConfigs + "footbot_robot.xml", "--link", footbot.link}, folder.path());
  ASSERT_TRUE(eventually([&] { return footbot.moves(); }, 20.0)) << robot.errors();
  footbot.hang_up();
  ASSERT_TRUE(eventually([&] { return !footbot.moves(); }, 10.0)) << "before it drives on it is stopped";
  EXPECT_TRUE(waits_for_a_person(robot, [&] { return footbot.moves(); }));
  robot.signal(SIGINT);
  EXPECT_EQ(robot.wait(), 130);
  EXPECT_FALSE(footbot.moves());
}

class KilledHub : public testing::TestWithParam<const char*> {};

TEST_P(KilledHub, LeavesAFootbotStoppedWhereItsModulesKeepTheirVariablesNow) {
  Folder folder;
  FootbotOnTcp footbot;
  folder.write("e.xml",
               R"(<tandem><framework><experiment length="0" ticks_per_second="10"/><time mode="realtime"/></framework>
<controllers><drive id="d" library="test_controllers"><actuators><differential_steering/></actuators>
<sensors/><params left="5 cm/s" right="5 cm/s"/></drive></controllers>
<arena size="40,40,1"><foot-bot id="fb0"><body position="0,0,0"/><controller config="d"/>
<bridge link=")" + footbot.link +
                   R"(" map=")" + kConfigs + R"(footbot_map.xml"/></foot-bot></arena>
<physics_engines><kinematics2d id="k"/></physics_engines></tandem>)");
  Tandem hub({GetParam(), "e.xml"}, folder.path());
  const auto speed = [&](const char* motor) {
    return footbot.with([&](auto& m) { return static_cast<int>(m.word(motor, "speed")); });
  };
  const auto drives = [&] { return speed("left motor") == 12 && speed("right motor") == 12; };
  ASSERT_TRUE(eventually(drives, 20.0)) << hub.errors();
  // A module is switched off, gets another program, and is there again.
  footbot.with([](auto& m) { m["left motor"].on = false; });
  ASSERT_TRUE(eventually([&] { return hub.errors().find("'left motor' is lost") != std::string::npos; }, 20.0));
  footbot.with([](auto& m) {
    auto& node = m["left motor"];
    const auto named = std::find_if(node.variables.begin(), node.variables.end(),
                                    [](const auto& variable) { return variable.first == "speed"; });
    node.variables.insert(named, {"temperature", 3});
    node.memory.assign(static_cast<std::size_t>(node.words()), 0);
    node.on = true;
  });
  ASSERT_TRUE(waits_for_a_person(hub, [&] { return footbot.moves(); })) << "its motor is not the one that was armed";
  ASSERT_TRUE(eventually(drives, 20.0)) << hub.errors();
  hub.signal(SIGKILL);
  EXPECT_TRUE(eventually([&] { return speed("left motor") == 0 && speed("right motor") == 0; }, 10.0));
}

INSTANTIATE_TEST_SUITE_P(Both, KilledHub, testing::Values("run", "robot"));

TEST(RealFootbot, IsNotDrivenWithoutItsSensors) {
  Folder folder;
  FootbotOnTcp footbot;
  footbot.with([](auto& m) { return m["proximity sensors"].on = false; });
  Tandem robot({"robot", kConfigs + "footbot_robot.xml", "--link", footbot.link}, folder.path());
  EXPECT_EQ(robot.wait(), 3);
  EXPECT_THAT(robot.errors(), HasSubstr("node 'proximity sensors' (or 'prox') is not there"));
  EXPECT_FALSE(footbot.moves());
}

TEST(RealFootbot, TellsWhatIsWrongWithItsMap) {
  Folder folder;
  std::string text = text_of(kConfigs + "footbot_robot.xml");
  text.replace(text.find("footbot_map.xml\" timeout"), 15, "wrong.xml");
  folder.write("robot.xml", text);
  folder.write("wrong.xml", "<footbot_map>\n<node names=\"a\"/>\n<nod/>\n</footbot_map>");
  Tandem robot({"robot", "robot.xml", "--link", "tcp:127.0.0.1:1"}, folder.path());
  EXPECT_EQ(robot.wait(), 1);
  EXPECT_THAT(robot.errors(), HasSubstr("wrong.xml:2: error: has neither a <variable> nor an <event>"));
  EXPECT_THAT(robot.errors(), HasSubstr("wrong.xml:3: error: <footbot_map> has no <nod>"));
}

TEST(RealFootbot, SaysThatNobodyListens) {
  Folder folder;
  Tandem robot({"robot", kConfigs + "footbot_robot.xml", "--link", "tcp:127.0.0.1:1"}, folder.path());
  EXPECT_EQ(robot.wait(), 3);
  EXPECT_THAT(robot.errors(), HasSubstr("cannot open tcp:127.0.0.1:1"));
}

TEST(RealFootbot, IsInspectedAndNothingMoves) {
  Folder folder;
  FootbotOnTcp footbot;
  footbot.with([](auto& m) { m.word("left motor", "speed") = 33; });
  Tandem inspect({"inspect", footbot.link}, folder.path());
  EXPECT_EQ(inspect.wait(), 0) << inspect.errors();
  EXPECT_THAT(inspect.output(), HasSubstr("'proximity sensors', ready, protocol 5"));
  EXPECT_THAT(inspect.output(), HasSubstr("battery     1 at 34    3777"));
  EXPECT_TRUE(footbot.moves());
  footbot.with([](auto& m) {
    for (const auto& node : m.nodes) EXPECT_EQ(node->writes, 0);
  });
  Tandem nobody({"inspect", "tcp:127.0.0.1:1", "--seconds", "0.5"}, folder.path());
  EXPECT_EQ(nobody.wait(), 3);
  EXPECT_THAT(nobody.errors(), HasSubstr("cannot open tcp:127.0.0.1:1"));
}

TEST(RealFootbot, ChecksItsMap) {
  Folder folder;
  folder.write("m.xml", "<footbot_map>\n<node names=\"a\"/>\n</footbot_map>");
  Tandem check({"check", "m.xml"}, folder.path());
  EXPECT_EQ(check.wait(), 1);
  EXPECT_THAT(check.errors(), HasSubstr("m.xml:2: error: has neither"));
}

TEST(RealFootbot, TakesPartInAMixedRun) {
  Folder folder;
  FootbotOnTcp footbot;
  folder.write("mixed.xml",
               R"(<tandem><framework><experiment length="2" ticks_per_second="10"/><time mode="realtime"/></framework>
<controllers><footbot_diffusion id="d" library="footbot_diffusion"><actuators><differential_steering/></actuators>
<sensors><footbot_proximity/></sensors><params velocity="5 cm/s"/></footbot_diffusion></controllers>
<arena size="4,4,1"><foot-bot id="real"><body position="0,0,0"/><controller config="d"/>
<bridge link=")" + footbot.link +
                   R"(" map=")" + kConfigs + R"(footbot_map.xml"/><tracker source="odometry"/></foot-bot>
<foot-bot id="virtual"><body position="1,1,0"/><controller config="d"/></foot-bot></arena>
<physics_engines><kinematics2d id="k"/></physics_engines></tandem>)");
  Tandem run({"run", "mixed.xml"}, folder.path());
  EXPECT_TRUE(eventually([&] { return footbot.moves(); }, 20.0));
  EXPECT_EQ(run.wait(), 0) << run.errors();
  EXPECT_FALSE(footbot.moves());
  EXPECT_THAT(run.output(), HasSubstr("stop confirmed"));
}

}  // namespace
}  // namespace tandem::scenarios
