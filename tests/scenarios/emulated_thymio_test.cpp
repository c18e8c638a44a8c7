// The command as a user types it, against an emulated Thymio; verdicts come from the robot's own log.
#include <gmock/gmock.h>

#include "tests/checkout.hpp"
#include "tests/scenarios/process.hpp"

namespace tandem::scenarios {
namespace {

using testing::HasSubstr;

const std::string kConfigs = std::string(test::kSourceDir) + "/configs/";
constexpr int kCruise = 200;  // 8 cm/s, where 500 is 20 cm/s

/// On a TCP port of its own, or on a pseudo-terminal "th0" in `folder`.
class EmulatedThymio : public EmulatedRobot {
 public:
  explicit EmulatedThymio(const Folder& folder, const std::vector<std::string>& more = {},
                          const std::string& link = "tcp-listen:127.0.0.1:0")
      : EmulatedRobot(folder, "thymio", link, more) {}
  /// What a host gives as its link.
  std::string link() const {
    const std::string text = errors();
    const std::size_t at = text.find("--link ") + 7;
    return text.substr(at, text.find(';', at) - at);
  }
  bool cruises() const {
    const auto all = wheels();
    return !all.empty() && all.back().left == kCruise && all.back().right == kCruise;
  }
};

std::vector<std::string> drive(const EmulatedThymio& thymio, std::vector<std::string> more = {}) {
  std::vector<std::string> arguments = {"robot", kConfigs + "thymio_robot.xml", "--link", thymio.link()};
  arguments.insert(arguments.end(), more.begin(), more.end());
  return arguments;
}

class ThroughTheThymiosDoors : public testing::TestWithParam<std::string> {};

TEST_P(ThroughTheThymiosDoors, ItIsDrivenByTheControllerOfTheSimulatedOnes) {
  Folder folder;
  EmulatedThymio thymio(folder, {}, GetParam());
  ASSERT_TRUE(thymio.ready());
  Tandem robot(drive(thymio, {"--seconds", "3", "--report", "r.json"}), folder.path());
  ASSERT_EQ(robot.wait(), 0) << robot.errors();
  const std::string report = text_of(folder.path() / "r.json");
  EXPECT_EQ(json_value(report, "state"), "active") << report;
  EXPECT_EQ(json_value(report, "programs_sent"), "1") << report;
  EXPECT_EQ(json_value(report, "not_understood"), "0") << report;
  int fastest = 0;
  for (const auto& w : thymio.wheels()) {
    EXPECT_EQ(w.left, w.right) << "straight on";
    fastest = std::max(fastest, w.left);
  }
  EXPECT_EQ(fastest, kCruise);
  EXPECT_FALSE(thymio.moves());
  EXPECT_EQ(thymio.end(), 0);
  EXPECT_THAT(thymio.log(), HasSubstr(R"("why":"stopped","left":0,"right":0)"));
}

INSTANTIATE_TEST_SUITE_P(Doors, ThroughTheThymiosDoors, testing::Values("tcp-listen:127.0.0.1:0", "pty:th0"));

class EmulatedThymioEndsStopped : public testing::TestWithParam<int> {};

TEST_P(EmulatedThymioEndsStopped, OnSignals) {
  Folder folder;
  EmulatedThymio thymio(folder);
  ASSERT_TRUE(thymio.ready());
  Tandem robot(drive(thymio), folder.path());
  ASSERT_TRUE(eventually([&] { return thymio.moves(); }, 20.0)) << robot.errors();
  robot.signal(GetParam());
  const bool killed = GetParam() == SIGKILL;
  EXPECT_EQ(robot.wait(), killed ? -SIGKILL : 128 + GetParam()) << robot.errors();
  EXPECT_TRUE(eventually([&] { return !thymio.moves(); }, killed ? 10.0 : 0.0)) << thymio.log();
}

INSTANTIATE_TEST_SUITE_P(Signals, EmulatedThymioEndsStopped, testing::Values(SIGINT, SIGTERM, SIGKILL));

TEST(EmulatedThymio, StopsByItselfWhenHubAndGuardianAreKilled) {
  Folder folder;
  EmulatedThymio thymio(folder);
  ASSERT_TRUE(thymio.ready());
  Tandem robot(drive(thymio), folder.path());
  ASSERT_TRUE(eventually([&] { return thymio.cruises(); }, 20.0)) << robot.errors();
  const pid_t guardian = robot.guardian();
  ASSERT_GT(guardian, 0);
  kill(guardian, SIGSTOP);
  robot.signal(SIGKILL);
  kill(guardian, SIGKILL);
  EXPECT_TRUE(eventually([&] { return !thymio.moves(); }, 5.0)) << thymio.log();
}

TEST(EmulatedThymio, IsStoppedAfterALinkLossBeforeItDrivesOn) {
  Folder folder;
  const std::string fault = "hangup@drive+2s+1s";
  EmulatedThymio thymio(folder, {"--fault", fault});
  ASSERT_TRUE(thymio.ready());
  Tandem robot(drive(thymio), folder.path());
  ASSERT_TRUE(eventually([&] { return thymio.moves(); }, 20.0)) << robot.errors();
  ASSERT_TRUE(eventually([&] { return thymio.fault_ns(fault, "begin") > 0; }, 20.0));
  // Its own program stops it, or the hub when the line is back: it may drive on soon after.
  const auto stopped_since = [&](long long t_ns) {
    const auto all = thymio.wheels();
    return std::any_of(all.begin(), all.end(),
                       [&](const auto& w) { return w.t_ns >= t_ns && w.left == 0 && w.right == 0; });
  };
  ASSERT_TRUE(eventually([&] { return stopped_since(thymio.fault_ns(fault, "begin")); }, 20.0)) << thymio.log();
  ASSERT_TRUE(eventually([&] { return thymio.fault_ns(fault, "end") > 0; }, 20.0));
  EXPECT_TRUE(waits_for_a_person(robot, [&] { return thymio.moves(); }));
  robot.signal(SIGINT);
  EXPECT_EQ(robot.wait(), 130) << robot.errors();
  EXPECT_FALSE(thymio.moves());
}

class ItsProgramIsGone : public testing::TestWithParam<std::string> {};

TEST_P(ItsProgramIsGone, AndIsLoadedAgain) {
  Folder folder;
  const std::string fault = GetParam() + "@drive+2s";
  EmulatedThymio thymio(folder, {"--fault", fault});
  ASSERT_TRUE(thymio.ready());
  Tandem robot(drive(thymio, {"--report", "r.json"}), folder.path());
  ASSERT_TRUE(eventually([&] { return thymio.moves(); }, 20.0)) << robot.errors();
  ASSERT_TRUE(eventually([&] { return thymio.fault_ns(fault, "begin") > 0; }, 20.0));
  const long long gone_ns = thymio.fault_ns(fault, "begin");
  for (const char* text : {"its program is gone", "robot stopped by itself"}) {
    EXPECT_TRUE(eventually([&] { return robot.errors().find(text) != std::string::npos; }, 20.0)) << robot.errors();
  }
  const auto cruises_again = [&] { return thymio.cruises() && thymio.wheels().back().t_ns > gone_ns; };
  EXPECT_TRUE(waits_for_a_person(robot, cruises_again)) << thymio.log();
  robot.signal(SIGTERM);
  EXPECT_EQ(robot.wait(), 143) << robot.errors();
  EXPECT_FALSE(thymio.moves());
  EXPECT_EQ(json_value(text_of(folder.path() / "r.json"), "programs_sent"), "2");
}

INSTANTIATE_TEST_SUITE_P(Faults, ItsProgramIsGone, testing::Values("restart", "program"));

TEST(EmulatedThymio, IsNotDrivenWhenItDescribesItselfWrongly) {
  Folder folder;
  EmulatedThymio thymio(folder, {"--fault", "lie=count"});
  ASSERT_TRUE(thymio.ready());
  Tandem robot(drive(thymio), folder.path());
  EXPECT_EQ(robot.wait(60), 3) << robot.errors();
  EXPECT_THAT(robot.errors(), HasSubstr("'thymio-II' describes itself as it cannot be"));
  EXPECT_FALSE(thymio.has_moved());
}

TEST(EmulatedThymio, IsLedAmongSimulatedOnes) {
  Folder folder;
  EmulatedThymio thymio(folder);
  ASSERT_TRUE(thymio.ready());
  Tandem hub({"run", kConfigs + "thymio_mixed.xml", "--set", "arena.thymio[th0].bridge.link=" + thymio.link(), "--set",
              "framework.experiment.length=6"},
             folder.path());
  EXPECT_EQ(hub.wait(60), 0) << hub.errors();
  EXPECT_TRUE(thymio.has_moved()) << hub.errors();
  EXPECT_FALSE(thymio.moves());
}

TEST(EmulatedThymio, LivesInAnArena) {
  Folder folder;
  std::string arena = text_of(kConfigs + "thymio_cruise.xml");
  const std::string ours = "<obstacle_avoidance id=\"avoid\" library=\"obstacle_avoidance\">";
  arena.replace(arena.find(ours), ours.size(), "<thymio_puppet id=\"avoid\" library=\"puppet\">");
  const std::string end = "</obstacle_avoidance>";
  arena.replace(arena.find(end), end.size(), "</thymio_puppet>");
  const std::string params = "<params cruise=\"8 cm/s\" gain=\"1.5\"/>";
  arena.erase(arena.find(params), params.size());
  folder.write("arena.xml", arena);
  EmulatedThymio thymio(folder, {"--arena", "arena.xml", "--body", "th0"});
  ASSERT_TRUE(thymio.ready());
  Tandem robot(drive(thymio, {"--seconds", "20"}), folder.path());
  EXPECT_EQ(robot.wait(60), 0) << robot.errors();
  bool turned = false;
  for (const auto& w : thymio.wheels()) turned = turned || w.left * w.right < 0 || w.left != w.right;
  EXPECT_TRUE(turned) << "it meets a wall or a post, and turns away";
  EXPECT_FALSE(thymio.moves());
}

}  // namespace
}  // namespace tandem::scenarios
