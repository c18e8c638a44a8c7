#include "bridges/guardian/same_robot.hpp"

#include <filesystem>
#include <fstream>
#include <gtest/gtest.h>

#include "tests/bridges/guardian/runtime_folder.hpp"

namespace tandem::bridges::guardian {
namespace {

namespace fs = std::filesystem;

class Trace : public testing::Test {
 protected:
  fs::path plug(const std::string& name) const { return runtime_.path() / name; }
  void plug_in(const std::string& name) const {
    fs::remove(plug(name));
    std::ofstream(plug(name)) << "";
  }
  /// A robot that its hub has found on `device`, by a link of that name or another.
  StopMessages found(const std::string& link, const std::string& device) const {
    StopMessages robot{"r", "e-puck", "serial:" + plug(link).string(), "", 1};
    robot.identity.device = plug(device).string();
    robot.identity.firmware = "Version 1";
    robot.identity.session = 1;
    return robot;
  }
  static StopMessages connected(const std::string& address) {
    StopMessages robot{"r", "e-puck", "tcp:robot:1000", "", 1};
    robot.identity.device = address;
    robot.identity.session = 1;
    return robot;
  }

  RuntimeFolder runtime_;
  RobotTrace trace_;
};

TEST_F(Trace, IsProvedOverADeviceThatStaysHoweverLongTheRobotIsSilent) {
  plug_in("4");
  trace_.begin(found("4", "4"));
  for (hal::TimeNs s = 0; s < 3600; s += 10) trace_.tried(false, s * hal::kNsPerSecond);
  trace_.look();
  EXPECT_TRUE(trace_.proved());
  EXPECT_EQ(trace_.same_as(found("4", "4")), SameRobot::Yes);
}

TEST_F(Trace, IsNotProvedOverADeviceThatWasMadeAnew) {
  plug_in("4");
  trace_.begin(found("4", "4"));
  plug_in("4");
  trace_.look();
  EXPECT_FALSE(trace_.proved());
  EXPECT_EQ(trace_.same_as(found("4", "4")), SameRobot::No);
  trace_.begin(found("4", "4"));  // the same session of its hub: nothing new is known
  EXPECT_FALSE(trace_.proved());
  StopMessages anew = found("4", "4");
  anew.identity.session = 2;  // the hub has found it again
  trace_.begin(anew);
  EXPECT_TRUE(trace_.proved());
}

TEST_F(Trace, IsNotProvedOverADeviceThatWasAwayUnseenAndKeepsWhatIsKnownWhileItsHubHasLostIt) {
  plug_in("4");
  trace_.begin(found("4", "4"));
  fs::remove(plug("4"));
  StopMessages lost = found("4", "4");
  lost.identity.device.reset();
  trace_.begin(lost);
  plug_in("4");
  trace_.look();
  EXPECT_FALSE(trace_.proved());
}

TEST_F(Trace, IsProvedWhereItsNameLeadsToAnotherDevice) {
  plug_in("4");
  fs::create_symlink(plug("4"), plug("by-id"));
  trace_.begin(found("by-id", "4"));
  fs::remove(plug("4"));
  trace_.look();
  EXPECT_FALSE(trace_.proved());
  plug_in("9");
  fs::remove(plug("by-id"));
  fs::create_symlink(plug("9"), plug("by-id"));
  trace_.look();
  EXPECT_TRUE(trace_.proved());
  EXPECT_EQ(trace_.same_as(found("by-id", "9")), SameRobot::Yes);
  EXPECT_EQ(trace_.same_as(found("other", "9")), SameRobot::No);
}

TEST_F(Trace, OverANetworkIsBrokenByTwoSecondsOfSilence) {
  trace_.begin(connected("10.0.0.7:1000"));
  trace_.tried(false, 10 * hal::kNsPerSecond);
  trace_.tried(false, 12 * hal::kNsPerSecond);
  EXPECT_TRUE(trace_.proved());
  trace_.tried(true, 12 * hal::kNsPerSecond + 1);
  trace_.tried(false, 13 * hal::kNsPerSecond);
  trace_.tried(false, 15 * hal::kNsPerSecond + 1);
  EXPECT_FALSE(trace_.proved());
  EXPECT_EQ(trace_.same_as(connected("10.0.0.7:1000")), SameRobot::No) << "the address may be another one's by now";
}

TEST_F(Trace, JudgesByWordsAndAddress) {
  plug_in("4");
  StopMessages mine = found("4", "4");
  trace_.begin(mine);
  EXPECT_EQ(trace_.same_as({}), SameRobot::Unknown) << "that hub has found nobody yet";
  StopMessages other = mine;
  other.identity.firmware = "Version 2";
  EXPECT_EQ(trace_.same_as(other), SameRobot::No);
  other = mine;
  other.kind = "thymio";
  EXPECT_EQ(trace_.same_as(other), SameRobot::No);
  mine.identity.address = "USB 4711";
  mine.identity.session = 2;
  trace_.begin(mine);
  plug_in("4");
  trace_.look();
  StopMessages moved = found("7", "7");
  moved.identity.address = "USB 4711";
  EXPECT_EQ(trace_.same_as(moved), SameRobot::Yes) << "wherever it is plugged in";
  moved.identity.address = "USB 4712";
  EXPECT_EQ(trace_.same_as(moved), SameRobot::No);
}

}  // namespace
}  // namespace tandem::bridges::guardian
