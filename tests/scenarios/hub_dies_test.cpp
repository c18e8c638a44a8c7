// Hubs that are killed or frozen in a run with real robots of all kinds; verdicts come from the robots' own logs.
#include <cstdlib>
#include <gmock/gmock.h>
#include <sched.h>

#include "tests/checkout.hpp"
#include "tests/scenarios/process.hpp"

namespace tandem::scenarios {
namespace {

using testing::HasSubstr;

constexpr long long kMs = 1'000'000;

/// From the death or freeze of a hub to the stop of a robot that can be reached, and of another from when it can be.
constexpr long long kAfterDeath_ns = 250 * kMs, kAfterFreeze_ns = 500 * kMs, kAfterReturn_ns = 1000 * kMs;

/// In a network of its own, where LCM reaches this program's children and nobody else.
class RobotsOfAllKinds : public testing::Test {
 protected:
  static void SetUpTestSuite() {
    apart_ = ::unshare(CLONE_NEWNET) == 0 && std::system("ip link set lo up && ip route add 224.0.0.0/4 dev lo") == 0;
  }
  void SetUp() override {
    if (!apart_) GTEST_SKIP() << "this machine does not permit a network of its own (unshare, as root; iproute2)";
    ::setenv("XDG_RUNTIME_DIR", hub_folder.path().c_str(), 1);
    epuck = std::make_unique<EmulatedEpuck>(epuck_folder);
    deaf = std::make_unique<EmulatedEpuck>(deaf_folder);
    footbot = std::make_unique<EmulatedFootbot>(footbot_folder);
    eyebot = std::make_unique<EmulatedEyebot>(eyebot_folder);
    ASSERT_TRUE(epuck->ready() && deaf->ready() && footbot->ready() && eyebot->ready());
    hub_folder.write("run.xml", experiment());
  }
  /// One controller forks a child that outlives the hub and holds all that it has open.
  std::string experiment() const {
    const std::string kind =
        "<actuators><differential_steering/></actuators><sensors/><params left=\"5 cm/s\" "
        "right=\"5 cm/s\"/>";
    const auto robot = [](const std::string& what, const std::string& place, const std::string& controller,
                          const std::string& bridge) {
      return "<" + what + "><body position=\"" + place + "\"/><controller config=\"" + controller +
             "\"/><bridge link=\"" + bridge + "\"/></" + what.substr(0, what.find(' ')) + ">";
    };
    const std::string map = std::string(test::kSourceDir) + "/configs/footbot_map.xml";
    return "<tandem><framework><experiment length=\"0\" ticks_per_second=\"20\" random_seed=\"1\"/><time "
           "mode=\"realtime\"/></framework><controllers><drive id=\"d\" library=\"test_controllers\">" +
           kind + "</drive><forker id=\"f\" library=\"test_controllers\">" + kind +
           "</forker><eyebot_hover id=\"h\" library=\"eyebot_hover\"><actuators><quadrotor_position/><flight_task/>"
           "</actuators><sensors><positioning/><flight_state/><clock/></sensors><params height=\"1.5 m\" "
           "offset=\"2,0,0\" duration=\"600 s\"/></eyebot_hover></controllers><arena size=\"40,40,4\" "
           "center=\"0,0,2\">" +
           robot("e-puck id=\"ep0\"", "-9,0,0", "d", "serial:" + (epuck_folder.path() / "ep0").string()) +
           robot("e-puck id=\"deaf\"", "-9,2,0", "f", "serial:" + (deaf_folder.path() / "ep0").string()) +
           robot("foot-bot id=\"fb0\"", "-9,4,0", "d",
                 "slcan:" + (footbot_folder.path() / "fb0").string() + "@1000000\" map=\"" + map) +
           robot("eye-bot id=\"eb0\"", "0,0,0", "h", EmulatedEyebot::kLink) +
           "</arena><physics_engines><dynamics3d id=\"k\"/></physics_engines></tandem>";
  }
  bool all_move() const { return epuck->moves() && deaf->moves() && footbot->moves() && eyebot->mode() == "position"; }

  /// Whether they all come to move before the hub ends.
  bool start(Tandem& hub) const {
    return eventually([&] { return all_move() || hub.wait(0.0) != -1000; }, 40.0) && all_move();
  }

  /// Since when the eye-bot has hovered; -1: it has not.
  long long hovers_since() const {
    const auto all = eyebot->lines("mode", {R"("to":"hover")"});
    return all.empty() ? -1 : std::stoll(json_value(all.back(), "t_ns"));
  }

  static inline bool apart_ = false;
  Folder hub_folder, epuck_folder, deaf_folder, footbot_folder, eyebot_folder;
  std::unique_ptr<EmulatedEpuck> epuck, deaf;
  std::unique_ptr<EmulatedFootbot> footbot;
  std::unique_ptr<EmulatedEyebot> eyebot;
};

TEST_F(RobotsOfAllKinds, AreStoppedAtOnceWhenTheirHubIsKilledAndTheUnreachableOneWhenItIsBack) {
  Tandem hub({"run", "run.xml"}, hub_folder.path());
  ASSERT_TRUE(start(hub)) << hub.errors();
  deaf->signal(SIGSTOP);
  const long long killed = monotonic_ns();
  hub.signal(SIGKILL);
  EXPECT_EQ(hub.wait(), -SIGKILL);
  EXPECT_TRUE(eventually([&] { return epuck->stands_since() > 0; }, 10.0)) << epuck->log();
  EXPECT_TRUE(stood_within(kAfterDeath_ns, *epuck, killed, epuck->stands_since()));
  EXPECT_TRUE(eventually([&] { return footbot->stands_since() > 0; }, 10.0)) << footbot->log();
  EXPECT_TRUE(stood_within(kAfterDeath_ns, *footbot, killed, footbot->stands_since()));
  EXPECT_TRUE(eventually([&] { return hovers_since() >= killed; }, 10.0)) << eyebot->log();
  EXPECT_TRUE(stood_within(kAfterDeath_ns, *eyebot, killed, hovers_since()));
  EXPECT_TRUE(eventually([&] { return eyebot->mode() == "idle"; }, 40.0)) << eyebot->modes();
  EXPECT_THAT(hub.errors(), HasSubstr("not stopped yet: 'deaf' on serial:"));
  // Hours later, as it were.
  const long long back = monotonic_ns();
  deaf->signal(SIGCONT);
  EXPECT_TRUE(eventually([&] { return deaf->stands_since() > 0; }, 10.0)) << deaf->log();
  EXPECT_TRUE(stood_within(kAfterReturn_ns, *deaf, back, deaf->stands_since()));
  EXPECT_TRUE(
      eventually([&] { return hub.errors().find("all robots have confirmed their stop") != std::string::npos; }, 10.0))
      << hub.errors();
}

TEST_F(RobotsOfAllKinds, AreStoppedWhileTheirHubIsFrozenAndWaitForAPersonWhoNamesEach) {
  Tandem hub({"run", "run.xml", "--report", "r.json"}, hub_folder.path());
  ASSERT_TRUE(start(hub)) << hub.errors();
  const long long frozen = monotonic_ns();
  hub.signal(SIGSTOP);
  EXPECT_TRUE(eventually([&] { return epuck->stands_since() > 0 && footbot->stands_since() > 0; }, 10.0));
  EXPECT_TRUE(stood_within(kAfterFreeze_ns, *epuck, frozen, epuck->stands_since()));
  EXPECT_TRUE(stood_within(kAfterFreeze_ns, *footbot, frozen, footbot->stands_since()));
  EXPECT_TRUE(eventually([&] { return eyebot->mode() == "hover"; }, 10.0)) << eyebot->modes();
  EXPECT_TRUE(stood_within(kAfterFreeze_ns, *eyebot, frozen, hovers_since()));
  const long long thawed = monotonic_ns();
  hub.signal(SIGCONT);
  const auto says = [&](const std::string& what) {
    return eventually([&] { return hub.errors().find(what) != std::string::npos; }, 30.0);
  };
  for (const char* id : {"ep0", "fb0", "eb0"}) EXPECT_TRUE(says("robot '" + std::string(id) + "' at")) << hub.errors();
  for (int i = 0; i < 10; ++i) {
    hub.signal(SIGUSR1);  // names nobody: their links were opened anew
    EXPECT_FALSE(eventually([&] { return epuck->moves() || footbot->moves(); }, 0.3)) << hub.errors();
  }
  for (const auto& w : epuck->wheels()) EXPECT_TRUE(w.t_ns < thawed || (w.left == 0 && w.right == 0)) << epuck->log();
  EXPECT_THAT(hub.errors(), HasSubstr("link was opened anew; waits to be re-armed"));
  EXPECT_THAT(hub.errors(), HasSubstr("this program was frozen for"));
  hub.signal(SIGINT);
  EXPECT_EQ(hub.wait(60.0), 130) << hub.errors();
  EXPECT_THAT(text_of(hub_folder.path() / "r.json"), HasSubstr("hub was frozen"));
  EXPECT_FALSE(epuck->moves());
  EXPECT_FALSE(footbot->moves());
}

TEST_F(RobotsOfAllKinds, AreStoppedBeforeTheirHubIsSuspended) {
  Tandem hub({"run", "run.xml"}, hub_folder.path());
  ASSERT_TRUE(start(hub)) << hub.errors();
  const long long asked = monotonic_ns();
  hub.signal(SIGTSTP);
  EXPECT_TRUE(eventually([&] { return epuck->stands_since() > 0 && footbot->stands_since() > 0; }, 10.0));
  EXPECT_TRUE(stood_within(300 * kMs, *epuck, asked, epuck->stands_since()));
  EXPECT_TRUE(eventually([&] { return hub.suspended(); }, 10.0));
  EXPECT_TRUE(eventually([&] { return eyebot->mode() == "hover"; }, 10.0)) << "its log may be later than its hub";
  hub.signal(SIGCONT);
  EXPECT_TRUE(eventually([&] { return hub.errors().find("waits to be re-armed") != std::string::npos; }, 30.0))
      << hub.errors();
  EXPECT_FALSE(eventually([&] { return epuck->moves() || footbot->moves(); }, 1.5)) << hub.errors();
}

TEST_F(RobotsOfAllKinds, HaveOneHub) {
  Tandem hub({"run", "run.xml"}, hub_folder.path());
  ASSERT_TRUE(start(hub)) << hub.errors();
  Tandem second({"run", "run.xml"}, hub_folder.path());
  EXPECT_EQ(second.wait(), 3);
  EXPECT_THAT(second.errors(), HasSubstr("is driven by process"));
  EXPECT_TRUE(all_move());
}

}  // namespace
}  // namespace tandem::scenarios
