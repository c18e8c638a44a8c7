// A robot that is pulled out while it drives, and whose device number another robot gets; verdicts come from the
// robots' own logs. In a mount namespace with pseudo-terminals of its own, so that their numbers are known.
#include <gmock/gmock.h>

#include "tests/scenarios/process.hpp"

namespace tandem::scenarios {
namespace {

using testing::HasSubstr;
using testing::Not;

fs::path device_of(const Folder& folder) {
  std::error_code error;
  return fs::read_symlink(folder.path() / "ep0", error);
}

void write_experiment(const Folder& hub, const std::string& id, const Folder& robot) {
  hub.write(id + ".xml",
            "<tandem><framework><experiment length=\"0\" ticks_per_second=\"20\" random_seed=\"1\"/><time "
            "mode=\"realtime\"/></framework><controllers><drive id=\"d\" library=\"test_controllers\"><actuators>"
            "<differential_steering/></actuators><sensors/><params left=\"3 cm/s\" right=\"3 cm/s\"/></drive>"
            "</controllers><arena size=\"40,40,4\"><e-puck id=\"" +
                id + "\"><body position=\"0,0,0\"/><controller config=\"d\"/><bridge link=\"serial:" +
                (robot.path() / "ep0").string() +
                "\"/></e-puck></arena><physics_engines><kinematics2d id=\"k\"/></physics_engines></tandem>");
}

TEST(RenumberedRobot, IsStoppedWhereItComesBackAndTheOneWithItsNumberIsLeftAlone) {
  if (!own_terminals()) GTEST_SKIP() << "this machine does not permit terminals of one's own (unshare, mount, as root)";
  const Folder hub_folder, a_folder, b_folder;
  ::setenv("XDG_RUNTIME_DIR", hub_folder.path().c_str(), 1);
  const EmulatedEpuck a(a_folder, {"--fault", "hangup@drive+1s+12s"});
  ASSERT_TRUE(a.ready());
  const fs::path number = device_of(a_folder);
  write_experiment(hub_folder, "A", a_folder);
  write_experiment(hub_folder, "B", b_folder);
  Tandem hub_a({"run", "A.xml"}, hub_folder.path());
  ASSERT_TRUE(eventually([&] { return a.moves(); }, 30.0)) << hub_a.errors();
  ASSERT_TRUE(eventually([&] { return a.fault_ns("hangup@drive+1s+12s", "begin") > 0; }, 20.0)) << a.log();
  ASSERT_TRUE(eventually([&] { return !fs::exists(number); }, 10.0)) << number;
  hub_a.signal(SIGKILL);

  const EmulatedEpuck b(b_folder);
  ASSERT_TRUE(b.ready());
  ASSERT_EQ(device_of(b_folder), number) << "it has got A's number";
  Tandem hub_b({"run", "B.xml"}, hub_folder.path());
  ASSERT_TRUE(eventually([&] { return b.moves() || hub_b.wait(0.0) != -1000; }, 40.0) && b.moves()) << hub_b.errors();
  const long long drives = monotonic_ns();

  ASSERT_TRUE(eventually([&] { return a.fault_ns("hangup@drive+1s+12s", "end") > 0; }, 30.0)) << a.log();
  EXPECT_NE(device_of(a_folder), number);
  ASSERT_TRUE(eventually([&] { return a.stands_since() > 0; }, 20.0)) << hub_a.errors();
  EXPECT_TRUE(stood_within(1'000'000'000, a, a.fault_ns("hangup@drive+1s+12s", "end"), a.stands_since()));
  EXPECT_TRUE(eventually([&] { return hub_a.guardian() < 0; }, 20.0));
  EXPECT_THAT(hub_a.errors(), HasSubstr("not stopped yet: 'A'"));
  EXPECT_THAT(hub_a.errors(), HasSubstr("all robots have confirmed their stop"));
  EXPECT_THAT(hub_a.errors(), Not(HasSubstr("handed over")));
  for (const auto& w : b.wheels()) EXPECT_TRUE(w.t_ns < drives || w.left != 0) << "B was stopped for A";
  hub_b.signal(SIGINT);
  EXPECT_EQ(hub_b.wait(60.0), 130) << hub_b.errors();
}

}  // namespace
}  // namespace tandem::scenarios
