// The command as a user types it, against an emulated eye-bot; verdicts come from the robot's own log.
#include <cstdlib>
#include <gmock/gmock.h>
#include <sched.h>

#include "tests/checkout.hpp"
#include "tests/scenarios/process.hpp"

namespace tandem::scenarios {
namespace {

using testing::HasSubstr;

constexpr long long kSecond_ns = 1'000'000'000;

long long time_of(const std::string& line) {
  return std::stoll(json_value(line, "t_ns"));
}

/// In a network of its own, where LCM reaches this program's children and nobody else.
class EmulatedEyebotFlies : public testing::Test {
 protected:
  static void SetUpTestSuite() {
    apart_ = ::unshare(CLONE_NEWNET) == 0 && std::system("ip link set lo up && ip route add 224.0.0.0/4 dev lo") == 0;
  }
  void SetUp() override {
    if (!apart_) GTEST_SKIP() << "this machine does not permit a network of its own (unshare, as root; iproute2)";
  }

  /// The greatest that the log tells of a coordinate.
  static double farthest(const EmulatedEyebot& eyebot, const std::string& coordinate) {
    double most_m = 0.0;
    for (const std::string& line : eyebot.lines("motion"))
      most_m = std::max(most_m, std::stod(json_value(line, coordinate)));
    return most_m;
  }
  static std::vector<std::string> drive(std::vector<std::string> more = {}) {
    std::vector<std::string> arguments = {"robot", std::string(test::kSourceDir) + "/configs/eyebot_robot.xml",
                                          "--link", EmulatedEyebot::kLink};
    arguments.insert(arguments.end(), more.begin(), more.end());
    return arguments;
  }
  /// Whether setpoints were obeyed since.
  static bool is_steered(const EmulatedEyebot& eyebot, long long since_ns) {
    for (const char* channel : {R"("channel":"cmd/position")", R"("channel":"cmd/velocity")"}) {
      for (const std::string& line : eyebot.lines("command", {channel, R"("verdict":"ok")"})) {
        if (time_of(line) >= since_ns) return true;
      }
    }
    return false;
  }

  static inline bool apart_ = false;
  Folder folder;
};

TEST_F(EmulatedEyebotFlies, AndLandsWhenItsHubEnds) {
  EmulatedEyebot eyebot(folder);
  ASSERT_TRUE(eyebot.ready());
  Tandem robot(drive({"--report", "r.json"}), folder.path());
  const auto is_there = [&] { return eyebot.mode() == "position" && farthest(eyebot, "z") > 1.4; };
  ASSERT_TRUE(eventually(is_there, 40.0)) << robot.errors() << eyebot.modes();
  robot.signal(SIGINT);
  ASSERT_TRUE(eventually([&] { return eyebot.mode() == "land"; }, 20.0)) << eyebot.modes();
  for (const int impatient : {SIGINT, SIGINT, SIGTERM, SIGHUP}) robot.signal(impatient);
  ASSERT_EQ(robot.wait(60), 130) << robot.errors();
  EXPECT_EQ(eyebot.mode(), "idle") << "its landing is not cut short";
  EXPECT_THAT(robot.errors(), HasSubstr("lands; nothing but its landing ends that"));
  EXPECT_THAT(eyebot.modes(), HasSubstr("idle takeoff hover position "));
  EXPECT_TRUE(eventually([&] { return eyebot.mode() == "idle"; }, 20.0)) << eyebot.modes();
  EXPECT_NEAR(farthest(eyebot, "z"), 1.5, 0.1);
  EXPECT_TRUE(eyebot.lines("failsafe").empty()) << eyebot.log();
  EXPECT_TRUE(eyebot.lines("malformed").empty()) << eyebot.log();
  const std::string report = text_of(folder.path() / "r.json");
  EXPECT_EQ(json_value(report, "state"), "active") << report;
  EXPECT_EQ(json_value(report, "links_lost"), "0") << report;
  EXPECT_EQ(json_value(report, "messages_refused"), "0") << report;
  EXPECT_EQ(eyebot.end(), 0);
}

TEST_F(EmulatedEyebotFlies, OnAfterAShortDeafness) {
  const std::string fault = "deaf@drive+3s+1500ms";
  EmulatedEyebot eyebot(folder, {"--fault", fault});
  ASSERT_TRUE(eyebot.ready());
  Tandem robot(drive(), folder.path());
  ASSERT_TRUE(eventually([&] { return eyebot.fault_ns(fault, "end") > 0; }, 60.0)) << robot.errors();
  const long long back_ns = eyebot.fault_ns(fault, "end");
  const auto told = [&] { return eyebot.lines("command", {R"("channel":"cmd/position")", R"("verdict":"ok")"}); };
  ASSERT_TRUE(eventually([&] { return eyebot.mode() == "position" && time_of(told().back()) > back_ns; }, 20.0))
      << eyebot.log() << robot.errors();
  EXPECT_TRUE(eyebot.lines("failsafe", {R"("to":"link_lost")"}).empty()) << eyebot.log();
  EXPECT_THAT(robot.errors(), testing::Not(HasSubstr("waits to be re-armed")));
  robot.signal(SIGINT);
  EXPECT_EQ(robot.wait(60), 130) << robot.errors();
  EXPECT_TRUE(eventually([&] { return eyebot.mode() == "idle"; }, 20.0)) << eyebot.modes();
}

TEST_F(EmulatedEyebotFlies, OnAfterALongDeafnessWhenAPersonReArmsIt) {
  const std::string fault = "deaf@drive+3s+4s";  // it is heard all the time, but was not there for its hub
  EmulatedEyebot eyebot(folder, {"--fault", fault});
  ASSERT_TRUE(eyebot.ready());
  Tandem robot(drive(), folder.path());
  ASSERT_TRUE(eventually([&] { return eyebot.fault_ns(fault, "end") > 0; }, 60.0)) << robot.errors();
  EXPECT_FALSE(eyebot.lines("failsafe", {R"("to":"link_lost")"}).empty()) << eyebot.log();
  EXPECT_THAT(eyebot.modes(eyebot.fault_ns(fault, "begin")), testing::StartsWith("hover ")) << eyebot.log();
  EXPECT_TRUE(waits_for_a_person(robot, [&] { return eyebot.mode() == "position"; })) << eyebot.log();
  robot.signal(SIGINT);
  EXPECT_EQ(robot.wait(60), 130) << robot.errors();
  EXPECT_TRUE(eventually([&] { return eyebot.mode() == "idle"; }, 20.0)) << eyebot.modes();
}

TEST_F(EmulatedEyebotFlies, OnWhenItsLinkIsBackAndAPersonReArmsIt) {
  const std::string deaf = "deaf@drive+3s+5s", silent = "silent@drive+3s+5s";
  EmulatedEyebot eyebot(folder, {"--fault", deaf, "--fault", silent});
  ASSERT_TRUE(eyebot.ready());
  Tandem robot(drive(), folder.path());
  const auto is_back = [&] { return std::min(eyebot.fault_ns(deaf, "end"), eyebot.fault_ns(silent, "end")) > 0; };
  ASSERT_TRUE(eventually(is_back, 60.0)) << robot.errors();
  const long long cut_ns = eyebot.fault_ns(deaf, "begin");
  EXPECT_FALSE(eyebot.lines("failsafe", {R"("to":"link_lost")"}).empty()) << eyebot.log();
  EXPECT_THAT(eyebot.modes(cut_ns), testing::StartsWith("hover ")) << eyebot.log();
  EXPECT_TRUE(waits_for_a_person(robot, [&] { return eyebot.mode() == "position"; })) << eyebot.log();
  robot.signal(SIGINT);
  EXPECT_EQ(robot.wait(60), 130) << robot.errors();
  EXPECT_TRUE(eventually([&] { return eyebot.mode() == "idle"; }, 20.0)) << eyebot.modes();
}

TEST_F(EmulatedEyebotFlies, NotOnWithoutALink) {
  const std::string fault = "deaf@drive+3s+30s";
  EmulatedEyebot eyebot(folder, {"--fault", fault});
  ASSERT_TRUE(eyebot.ready());
  Tandem robot(drive(), folder.path());
  ASSERT_TRUE(eventually([&] { return eyebot.fault_ns(fault, "begin") > 0; }, 60.0)) << robot.errors();
  const long long cut_ns = eyebot.fault_ns(fault, "begin");
  ASSERT_TRUE(eventually([&] { return eyebot.mode() == "idle"; }, 25.0)) << eyebot.modes();
  EXPECT_EQ(eyebot.modes(cut_ns), "hover land idle ");
  EXPECT_FALSE(is_steered(eyebot, cut_ns));
  const auto landed = eyebot.lines("landed");
  ASSERT_FALSE(landed.empty());
  EXPECT_LT(std::stod(json_value(landed.back(), "speed_m_s")), 0.35);
}

TEST_F(EmulatedEyebotFlies, NoFurtherWhenItsHubIsKilled) {
  EmulatedEyebot eyebot(folder);
  ASSERT_TRUE(eyebot.ready());
  Tandem robot(drive(), folder.path());
  ASSERT_TRUE(eventually([&] { return eyebot.mode() == "position"; }, 20.0)) << robot.errors();
  robot.signal(SIGKILL);
  EXPECT_EQ(robot.wait(), -SIGKILL);
  const long long dead_ns = monotonic_ns();
  ASSERT_TRUE(eventually([&] { return eyebot.mode() == "idle"; }, 40.0)) << eyebot.log();
  EXPECT_THAT(eyebot.modes(), testing::EndsWith("position hover land idle "));
  EXPECT_FALSE(is_steered(eyebot, dead_ns)) << eyebot.log();
}

TEST_F(EmulatedEyebotFlies, OnNoStaleCommand) {
  const std::string fault = "lag=600ms@drive+3s+3s";
  EmulatedEyebot eyebot(folder, {"--fault", fault});
  ASSERT_TRUE(eyebot.ready());
  Tandem robot(drive(), folder.path());
  ASSERT_TRUE(eventually([&] { return eyebot.fault_ns(fault, "end") > 0; }, 60.0)) << robot.errors();
  const auto stale = eyebot.lines("command", {R"("verdict":"rejected_stale")"});
  EXPECT_FALSE(stale.empty()) << eyebot.log();
  for (const std::string& line : eyebot.lines("command", {R"("verdict":"ok")"})) {
    EXPECT_LE(std::stoll(json_value(line, "age_us")), 250'000) << line;
  }
  ASSERT_TRUE(eventually([&] { return eyebot.mode() == "position"; }, 20.0)) << robot.errors();
  robot.signal(SIGINT);
  EXPECT_EQ(robot.wait(60), 130) << robot.errors();
}

TEST_F(EmulatedEyebotFlies, UntilItsBatteryIsLowAndLandsBeforeItSavesItself) {
  EmulatedEyebot eyebot(folder, {"--fault", "battery=0.13@drive+4s"});
  ASSERT_TRUE(eyebot.ready());
  Tandem robot(drive(), folder.path());
  ASSERT_TRUE(eventually([&] { return eyebot.mode() == "position"; }, 40.0)) << robot.errors();
  EXPECT_TRUE(eventually([&] { return eyebot.mode() == "idle"; }, 60.0)) << eyebot.modes();
  EXPECT_THAT(robot.errors(), HasSubstr("battery low"));
  EXPECT_TRUE(eyebot.lines("failsafe").empty()) << eyebot.log();
  robot.signal(SIGINT);
  EXPECT_EQ(robot.wait(60), 130) << robot.errors();
}

TEST_F(EmulatedEyebotFlies, OnABadNetwork) {
  EmulatedEyebot eyebot(folder, {"--fault", "drop=0.1", "--fault", "lose=0.1", "--fault", "double=0.1", "--fault",
                                 "repeat=0.1", "--fault", "swap=0.1", "--fault", "overtake=0.1", "--fault",
                                 "fingerprint=0.02", "--fault", "truncate=0.02"});
  ASSERT_TRUE(eyebot.ready());
  Tandem robot(drive(), folder.path());
  const auto is_there = [&] { return eyebot.mode() == "position" && farthest(eyebot, "z") > 1.4; };
  EXPECT_TRUE(eventually(is_there, 60.0)) << robot.errors() << eyebot.modes();
  robot.signal(SIGINT);
  EXPECT_EQ(robot.wait(80), 130) << robot.errors();
  EXPECT_THAT(eyebot.modes(), HasSubstr("takeoff hover position"));
  EXPECT_TRUE(eventually([&] { return eyebot.mode() == "idle"; }, 25.0)) << eyebot.modes();
}

TEST_F(EmulatedEyebotFlies, InASimulatedArena) {
  folder.write(
      "arena.xml",
      R"(<tandem><framework><experiment length="0" ticks_per_second="50" random_seed="1"/></framework><controllers>
<eyebot_puppet id="p" library="puppet"><actuators><flight_task/><quadrotor_speed/></actuators><sensors><flight_state/>
<positioning/><altimeter/></sensors></eyebot_puppet></controllers><arena size="8,8,4" center="0,0,2">
<eye-bot id="body"><body position="1,0,0"/><controller config="p"/></eye-bot></arena>
<physics_engines><particle3d id="k"/></physics_engines></tandem>)");
  EmulatedEyebot eyebot(folder, {"--arena", "arena.xml", "--body", "body"});
  ASSERT_TRUE(eyebot.ready());
  Tandem robot(drive(), folder.path());
  EXPECT_TRUE(eventually([&] { return farthest(eyebot, "x") > 1.4; }, 60.0)) << robot.errors() << eyebot.modes();
  robot.signal(SIGINT);
  EXPECT_EQ(robot.wait(60), 130) << robot.errors();
  EXPECT_NEAR(farthest(eyebot, "x"), 1.5, 0.1) << "half a metre ahead of where the simulated one stood";
  EXPECT_TRUE(eventually([&] { return eyebot.mode() == "idle"; }, 25.0)) << eyebot.modes();

  Tandem nobody({"emulate", "eyebot", "--link", EmulatedEyebot::kLink, "--arena", "arena.xml", "--body", "x"},
                folder.path());
  EXPECT_EQ(nobody.wait(), 1);
  EXPECT_THAT(nobody.errors(), HasSubstr("no robot 'x'"));
}

TEST_F(EmulatedEyebotFlies, WithEveryReportAnswered) {
  Tandem bench({"bench", "sense_to_act", "--robots", "3", "--seconds", "0.5"}, folder.path());
  ASSERT_EQ(bench.wait(60), 0) << bench.errors();
  const std::string line = bench.output();
  EXPECT_EQ(json_value(line, "robots"), "3");
  EXPECT_EQ(json_value(line, "commands_refused"), "0") << line;
  EXPECT_GT(std::stoll(json_value(line, "reports_answered")), 30) << line;
  EXPECT_GT(std::stod(json_value(line, "p50_us")), 0.0) << line;
  EXPECT_LE(std::stod(json_value(line, "p50_us")), std::stod(json_value(line, "p99_us"))) << line;
  Tandem many({"bench", "sense_to_act", "--robots", "1000"}, folder.path());
  EXPECT_EQ(many.wait(), 2);
  EXPECT_THAT(many.errors(), HasSubstr("at most 100"));
}

}  // namespace
}  // namespace tandem::scenarios
