// Robots of one name, of twenty programs that were killed with their guardians: the next command stops them all at
// once. Verdicts come from the robots' own logs.
#include <gmock/gmock.h>
#include <memory>

#include "tests/scenarios/process.hpp"

namespace tandem::scenarios {
namespace {

using testing::HasSubstr;

constexpr long long kMs = 1'000'000;
constexpr int kRobots = 20;

/// An e-puck in a process of its own, and the program that drives it.
struct Left {
  Folder folder;
  EmulatedEpuck robot{folder};
  std::unique_ptr<Tandem> hub;
  bool answers = true;

  void start() {
    folder.write("robot.xml",
                 "<tandem><framework><experiment length=\"0\" ticks_per_second=\"20\"/></framework><controllers>"
                 "<drive id=\"d\" library=\"test_controllers\"><actuators><differential_steering/></actuators>"
                 "<sensors/><params left=\"3 cm/s\" right=\"3 cm/s\"/></drive></controllers><arena size=\"2,2,1\">"
                 "<e-puck id=\"ep0\"><body position=\"0,0,0\"/><controller config=\"d\"/><bridge "
                 "link=\"serial:ep0\"/></e-puck></arena></tandem>");
    hub = std::make_unique<Tandem>(std::vector<std::string>{"robot", "robot.xml"}, folder.path());
  }
  void kill_both() const {
    const pid_t guardian = hub->guardian();
    ASSERT_GT(guardian, 1);
    kill(guardian, SIGSTOP);  // so that it stops nobody
    hub->signal(SIGKILL);
    kill(guardian, SIGKILL);
    ASSERT_EQ(hub->wait(), -SIGKILL);
    ASSERT_TRUE(eventually([guardian] { return kill(guardian, 0) != 0; }, 10.0));
  }
};

TEST(LeftRobots, OfOneNameAreAllAtRestInTheTimeThatOneTakesThoughSomeDoNotAnswer) {
  const Folder locks;
  ::setenv("XDG_RUNTIME_DIR", locks.path().c_str(), 1);
  std::vector<std::unique_ptr<Left>> all;
  for (int i = 0; i < kRobots; ++i) {
    ASSERT_TRUE(all.emplace_back(std::make_unique<Left>())->robot.ready());
    all.back()->start();
    all.back()->answers = i % 5 != 0;
  }
  for (const auto& left : all)
    ASSERT_TRUE(eventually([&] { return left->robot.moves(); }, 60.0)) << left->hub->errors();
  for (const auto& left : all) ASSERT_NO_FATAL_FAILURE(left->kill_both());
  for (const auto& left : all) {
    EXPECT_TRUE(left->robot.moves());
    if (!left->answers) left->robot.signal(SIGSTOP);
  }
  Tandem next({"preflight", "robot.xml", "--wait", "1"}, all[1]->folder.path());
  long long first_ns = 0;
  for (const auto& left : all) {
    if (!left->answers) continue;
    ASSERT_TRUE(eventually([&] { return left->robot.stands_since() > 0; }, 60.0)) << next.errors();
    first_ns = first_ns == 0 ? left->robot.stands_since() : std::min(first_ns, left->robot.stands_since());
  }
  for (const auto& left : all) {
    if (!left->answers) continue;
    EXPECT_TRUE(stood_within(500 * kMs, left->robot, first_ns, left->robot.stands_since()));
  }
  EXPECT_NE(next.wait(60.0), -1000) << next.threads();
  EXPECT_THAT(next.errors(), HasSubstr("It was stopped now, and has confirmed that"));
  EXPECT_THAT(next.errors(), HasSubstr("It was told to stop now, and has NOT confirmed that"));
  for (const auto& left : all) left->robot.signal(SIGCONT);
  for (const auto& left : all) EXPECT_TRUE(eventually([&] { return left->robot.stands_since() > 0; }, 20.0));
}

TEST(LeftRobots, AreStoppedAndToldOfByWhoeverInspectsThemToo) {
  const Folder locks;
  ::setenv("XDG_RUNTIME_DIR", locks.path().c_str(), 1);
  Left left;
  ASSERT_TRUE(left.robot.ready());
  left.start();
  ASSERT_TRUE(eventually([&] { return left.robot.moves(); }, 60.0)) << left.hub->errors();
  ASSERT_NO_FATAL_FAILURE(left.kill_both());
  EXPECT_TRUE(left.robot.moves());
  Tandem next({"inspect", "serial:ep0", "--seconds", "0.5"}, left.folder.path());
  EXPECT_EQ(next.wait(60.0), 0) << next.errors();
  EXPECT_THAT(next.errors(), HasSubstr("It was stopped now, and has confirmed that"));
  EXPECT_GT(left.robot.stands_since(), 0);
}

}  // namespace
}  // namespace tandem::scenarios
