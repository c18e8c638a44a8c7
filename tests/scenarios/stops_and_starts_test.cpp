// What a hub does about real robots that are left out, wait for a person, or do not confirm their stop: both commands,
// against emulated e-pucks whose own logs are the witnesses.
#include <fcntl.h>
#include <gmock/gmock.h>
#include <optional>
#include <sys/prctl.h>
#include <sys/resource.h>

#include "tests/scenarios/process.hpp"

namespace tandem::scenarios {
namespace {

using testing::AllOf;
using testing::HasSubstr;
using testing::Not;

constexpr int kCapSysNice = 23;  // <linux/capability.h>

struct Said {
  std::string bridge = {};  // attributes
  std::string time = {};    // attributes of <time>
  int length_s = 0;
};

std::string epuck(const std::string& id, const std::string& place, const std::string& bridge) {
  return "<e-puck id=\"" + id + "\"><body position=\"" + place + "\"/><controller config=\"d\"/><bridge " + bridge +
         "/></e-puck>";
}

std::string experiment(const std::string& robots, const Said& said = {}) {
  return "<tandem><framework><experiment length=\"" + std::to_string(said.length_s) +
         "\" ticks_per_second=\"20\" random_seed=\"1\"/><time mode=\"realtime\" " + said.time +
         "/></framework><controllers><drive id=\"d\" library=\"test_controllers\"><actuators><differential_steering/>"
         "</actuators><sensors/><params left=\"5 cm/s\" right=\"5 cm/s\"/></drive></controllers>"
         "<arena size=\"40,40,4\">" +
         robots + "</arena><physics_engines><kinematics2d id=\"k\"/></physics_engines></tandem>";
}

/// One real robot, `tandem run` and `tandem robot`.
class Hubs : public testing::TestWithParam<const char*> {
 protected:
  void SetUp() override {
    ::setenv("XDG_RUNTIME_DIR", folder_.path().c_str(), 1);
    ASSERT_TRUE(epuck_.ready());
  }
  std::unique_ptr<Tandem> start(const Said& said = {}) const {
    folder_.write("e.xml", experiment(epuck("ep0", "-9,0,0", "link=\"serial:ep0\" " + said.bridge), said));
    return std::make_unique<Tandem>(std::vector<std::string>{GetParam(), "e.xml", "--report", "r.json"},
                                    folder_.path());
  }
  bool drives(Tandem& hub) const {
    return eventually([&] { return epuck_.moves() || hub.wait(0.0) != -1000; }, 30.0) && epuck_.moves();
  }
  bool stands() const {
    return eventually([&] { return !epuck_.moves(); }, 20.0);
  }
  static bool says(const Tandem& hub, const std::string& what) {
    return eventually([&] { return hub.errors().find(what) != std::string::npos; }, 20.0);
  }

  Folder folder_;
  EmulatedEpuck epuck_{folder_};
};
INSTANTIATE_TEST_SUITE_P(Both, Hubs, testing::Values("run", "robot"));

TEST_P(Hubs, LetARobotStandUntilAPersonReArmsIt) {
  auto hub = start();
  ASSERT_TRUE(drives(*hub)) << hub->errors();
  hub->signal(SIGSTOP);
  ASSERT_TRUE(stands()) << epuck_.log();
  hub->signal(SIGCONT);
  EXPECT_TRUE(waits_for_a_person(*hub, [&] { return epuck_.moves(); })) << epuck_.log();
  EXPECT_THAT(hub->errors(), HasSubstr("hub was frozen"));
  hub->signal(SIGINT);
  EXPECT_EQ(hub->wait(), 130) << hub->errors();
  EXPECT_FALSE(epuck_.moves());
}

TEST_P(Hubs, SayThatAPriorityWasRefusedAndGoOn) {
  std::unique_ptr<Tandem> hub;
  std::thread unprivileged([&] {  // capabilities belong to threads
    ::prctl(PR_CAPBSET_DROP, kCapSysNice);
    const rlimit none{};
    ::setrlimit(RLIMIT_RTPRIO, &none);
    hub = start({.time = "priority=\"40\"", .length_s = 1});
  });
  unprivileged.join();
  EXPECT_EQ(hub->wait(60.0), 0) << hub->errors();
  EXPECT_THAT(hub->errors(), AllOf(HasSubstr("real-time priority 40 (SCHED_FIFO) was refused"), HasSubstr("ulimit -r"),
                                   HasSubstr("going on without")));
  EXPECT_TRUE(epuck_.has_moved());
  EXPECT_FALSE(epuck_.moves());
}

TEST_P(Hubs, NameARobotWhoseLinkIsDeadAtTheEnd) {
  for (const int signal : {0, SIGINT, SIGTERM}) {
    auto hub = start({.length_s = signal == 0 ? 5 : 0});
    ASSERT_TRUE(drives(*hub)) << hub->errors();
    epuck_.signal(SIGSTOP);  // nothing comes back any more
    const auto told = std::chrono::steady_clock::now();
    if (signal != 0) hub->signal(signal);
    EXPECT_EQ(hub->wait(60.0), 3) << hub->errors();
    const std::chrono::duration<double> ended_after_s = std::chrono::steady_clock::now() - told;
    EXPECT_TRUE(signal == 0 || ended_after_s.count() <= 2.0) << ended_after_s.count();
    EXPECT_THAT(hub->errors(), HasSubstr("robot 'ep0'"));
    EXPECT_THAT(hub->errors(), HasSubstr("did not confirm its stop: switch it off by hand if it moves"));
    const std::string report = text_of(folder_.path() / "r.json");
    EXPECT_EQ(json_value(report, "stop_confirmed"), "false") << report;
    // The guardian goes on, and the robot stands as soon as it can hear.
    epuck_.signal(SIGCONT);
    EXPECT_TRUE(stands()) << epuck_.log();
    EXPECT_TRUE(eventually([&] { return hub->guardian() < 0; }, 20.0)) << hub->errors();
  }
}

TEST_P(Hubs, StopRobotsWhoseGuardianIsGone) {
  auto hub = start();
  ASSERT_TRUE(drives(*hub)) << hub->errors();
  const pid_t guardian = hub->guardian();
  ASSERT_GT(guardian, 1);
  kill(guardian, SIGKILL);
  EXPECT_TRUE(stands()) << epuck_.log();
  EXPECT_TRUE(says(*hub, "the guardian process is gone, and nobody would stop")) << hub->errors();
  EXPECT_TRUE(says(*hub, "guardian gone")) << hub->errors();
  const std::size_t before = epuck_.wheels().size();
  hub->signal(SIGUSR1);  // no person can have it drive
  hub->signal(SIGINT);
  EXPECT_EQ(hub->wait(), 3) << hub->errors();
  const auto wheels = epuck_.wheels();
  for (std::size_t i = before; i < wheels.size(); ++i) EXPECT_TRUE(wheels[i].left == 0 && wheels[i].right == 0);
}

TEST_P(Hubs, AreNotEndedByARearmThatComesTooEarly) {
  auto hub = start();
  // As soon as the program has taken anything in hand: crashes first, or Ctrl-C where a sanitizer has them.
  ASSERT_TRUE(eventually([&] { return hub->catches(SIGTRAP) || hub->catches(SIGINT); }, 30.0));
  hub->signal(SIGUSR1);
  EXPECT_TRUE(drives(*hub)) << hub->errors();
  hub->signal(SIGINT);
  EXPECT_EQ(hub->wait(), 130) << hub->errors();
}

TEST_P(Hubs, DriveNoRobotWithoutAGuardian) {
  for (int fd = 3; fd < 256; ++fd) ::fcntl(fd, F_SETFD, FD_CLOEXEC);  // what this test was begun with
  rlimit before{};
  ::getrlimit(RLIMIT_NOFILE, &before);
  std::string said;
  // As few files as a hub can begin with: a guardian needs two more.
  for (rlim_t files = 4;
       files < 8 && said.find("no guardian") == std::string::npos && said.find("Too many") == std::string::npos;
       ++files) {
    const rlimit few{files, before.rlim_max};
    ::setrlimit(RLIMIT_NOFILE, &few);
    auto hub = start({.length_s = 1});
    ::setrlimit(RLIMIT_NOFILE, &before);
    EXPECT_NE(hub->wait(), 0) << hub->errors();
    said = hub->errors();
  }
  // Whether it fails at the guardian or at the lock of its link depends on what else it was begun with.
  EXPECT_THAT(said, testing::AnyOf(HasSubstr("no guardian process can be made"), HasSubstr("Too many open files")));
  EXPECT_FALSE(epuck_.has_moved());
}

/// Several robots, some of which may be left out.
class Without : public testing::Test {
 protected:
  void SetUp() override {
    ::setenv("XDG_RUNTIME_DIR", folder_.path().c_str(), 1);
    folder_.write("e.xml", experiment(epuck("ep0", "-9,0,0", "link=\"serial:ep0\"") +
                                          epuck("ep1", "-9,2,0", "link=\"serial:/dev/no_such_port\""),
                                      {.length_s = 2}));
  }
  int run(const std::vector<std::string>& without) {
    std::vector<std::string> words = {"run", "e.xml", "--report", "r.json"};
    for (const std::string& id : without) words.insert(words.end(), {"--without", id});
    Tandem hub(words, folder_.path());
    const int code = hub.wait(60.0);
    errors_ = hub.errors();
    report_ = text_of(folder_.path() / "r.json");
    return code;
  }
  Folder folder_;
  std::string errors_, report_;
};

TEST_F(Without, SimulatesThatRobotAndDrivesTheOthers) {
  EmulatedEpuck epuck(folder_);
  ASSERT_TRUE(epuck.ready());
  ASSERT_EQ(run({"ep1"}), 0) << errors_;
  EXPECT_TRUE(epuck.has_moved());
  EXPECT_EQ(json_value(report_, "robots"), "2") << report_;
  EXPECT_THAT(report_, AllOf(HasSubstr("\"id\":\"ep0\""), Not(HasSubstr("\"id\":\"ep1\""))));
  EXPECT_THAT(errors_, Not(HasSubstr("no_such_port")));
}

TEST_F(Without, AllOfThemOpensNoLink) {
  EmulatedEpuck epuck(folder_);
  ASSERT_TRUE(epuck.ready());
  ASSERT_EQ(run({"ep1", "ep0"}), 0) << errors_;
  EXPECT_TRUE(epuck.wheels().empty()) << epuck.log();
  EXPECT_THAT(report_, Not(HasSubstr("real_robots")));
}

TEST_F(Without, ARobotThatIsNotThereNamesThoseThatAre) {
  EXPECT_EQ(run({"ep7"}), 1);
  EXPECT_THAT(errors_, HasSubstr("--without ep7: there is no real robot of this name; there are: ep0, ep1"));
}

}  // namespace
}  // namespace tandem::scenarios
