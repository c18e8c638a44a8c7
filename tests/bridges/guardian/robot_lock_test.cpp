#include "bridges/guardian/robot_lock.hpp"

#include <algorithm>
#include <csignal>
#include <ctime>
#include <fstream>
#include <gtest/gtest.h>
#include <sys/wait.h>
#include <unistd.h>

#include "tests/bridges/guardian/runtime_folder.hpp"

namespace tandem::bridges::guardian {
namespace {

namespace fs = std::filesystem;

class LockedRobot : public testing::Test {
 protected:
  std::optional<RobotLock> take() {
    auto taken = RobotLock::take(folder_, key_, seen_);
    EXPECT_TRUE(taken.ok());
    return std::move(taken).value();
  }
  RuntimeFolder runtime_;
  std::string folder_ = lock_folder().value();
  StopMessages robot_ = {"ep0", "e-puck", "serial:/dev/rfcomm0@115200", std::string("a\n\0b", 4), 3};
  std::string key_ = written_key(robot_);
  std::optional<LockHolder> seen_;
};

TEST_F(LockedRobot, IsNotTakenTwiceAndNamesItsHolder) {
  const auto lock = take();
  ASSERT_TRUE(lock);
  EXPECT_FALSE(seen_);
  lock->write({robot_, 17, 18, LockState::Left});
  lock->write({robot_, 17, 18, LockState::Driven});
  EXPECT_FALSE(take());
  ASSERT_TRUE(seen_);
  EXPECT_EQ(seen_->robot, robot_);
  EXPECT_EQ(seen_->hub, 17);
  EXPECT_EQ(seen_->guardian, 18);
  EXPECT_EQ(seen_->state, LockState::Driven);
}

TEST_F(LockedRobot, LeavesNoFileBehindWhenItIsFreed) {
  {
    const auto lock = take();
    EXPECT_FALSE(fs::is_empty(folder_));
  }
  EXPECT_TRUE(fs::is_empty(folder_));
  EXPECT_TRUE(take());
}

TEST_F(LockedRobot, IsFreeOnceItsHolderWasKilledWhateverItsFileSays) {
  const pid_t holder = ::fork();
  if (holder == 0) {
    const auto lock = take();
    lock->write({robot_, 1, ::getpid(), LockState::Driven});
    ::kill(::getpid(), SIGKILL);
  }
  ::waitpid(holder, nullptr, 0);
  EXPECT_FALSE(fs::is_empty(folder_));
  EXPECT_TRUE(take());
  ASSERT_TRUE(seen_);  // how it is stopped is not lost
  EXPECT_EQ(seen_->robot.body, robot_.body);
  EXPECT_EQ(seen_->guardian, holder);
}

TEST_F(LockedRobot, MayHaveAFileThatIsNonsense) {
  std::ofstream(folder_ + "/" + key_ + ".lock") << "robot x\nstop W3:\n";
  EXPECT_TRUE(take());
  EXPECT_FALSE(seen_);
}

StopMessages reached_over(const std::string& link, const std::string& name = "") {
  StopMessages robot;
  robot.link = link;
  robot.name = name;
  return robot;
}

/// Whether two robots, so reached, have a lock in common.
bool one_robot(const StopMessages& a, const StopMessages& b) {
  const auto of_b = lock_keys(b);
  return std::ranges::any_of(lock_keys(a), [&](const auto& key) { return std::ranges::find(of_b, key) != of_b.end(); });
}

TEST_F(LockedRobot, IsTheSameUnderAnotherNameOfItsDevice) {
  const fs::path device = runtime_.path() / "ttyUSB7", alias = runtime_.path() / "by-id";
  std::ofstream(device) << "";
  fs::create_symlink(device, alias);
  const auto same = [](const std::string& a, const std::string& b) {
    return one_robot(reached_over(a), reached_over(b));
  };
  EXPECT_TRUE(same("serial:" + device.string() + "@115200", "serial:" + alias.string()));
  EXPECT_FALSE(same("serial:/dev/rfcomm0", "serial:/dev/rfcomm1"));
  EXPECT_FALSE(same("tcp:10.0.0.1:33333", "tcp:10.0.0.2:33333"));
  const std::string net = "lcm:udpm://239.255.76.67:7667";
  EXPECT_FALSE(one_robot(reached_over(net, "eb0"), reached_over(net, "eb1")));
  EXPECT_TRUE(one_robot(reached_over(net + "?ttl=0", "eb0"), reached_over(net + "?ttl=1", "eb0")));
  EXPECT_LT(written_key(reached_over("tcp:" + std::string(4000, '/'))).size(), 220U);
  EXPECT_EQ(written_key(reached_over("tcp:" + std::string(4000, '/'))).find('/'), std::string::npos);
}

TEST_F(LockedRobot, IsTheSameUnderAllNamesOfThisComputer) {
  for (const std::string scheme : {"tcp:", "epuck-tcp:"}) {
    for (const std::string host : {"localhost", "127.0.0.1", "[::1]"})
      EXPECT_TRUE(one_robot(reached_over(scheme + host + ":4711"), reached_over(scheme + "127.0.0.1:4711"))) << host;
    EXPECT_FALSE(one_robot(reached_over(scheme + "localhost:4711"), reached_over(scheme + "localhost:4712")));
  }
}

TEST_F(LockedRobot, IsTheSameOverTwoDevicesWhereItHasAnAddressOfItsOwn) {
  StopMessages one = reached_over("serial:/dev/rfcomm0"), other = reached_over("serial:/dev/rfcomm1");
  one.identity.address = other.identity.address = "node 4";  // on a bus of its own
  EXPECT_FALSE(one_robot(one, other));
  one.identity.address = other.identity.address = "Bluetooth 10:00:E8:12:34:56";
  EXPECT_TRUE(one_robot(one, other));
}

TEST_F(LockedRobot, KeepsTheLocksThatNobodyElseHasAndNamesWhoHasAnother) {
  std::optional<LockHolder> holder;
  RobotLocks left, live;
  EXPECT_EQ(left.change_to(folder_, {"a", "shared"}, holder).value(), true);
  EXPECT_FALSE(holder);
  left.write({robot_, 17, 18, LockState::Left});
  EXPECT_EQ(live.change_to(folder_, {"b", "shared"}, holder).value(), false);
  ASSERT_TRUE(holder);
  EXPECT_EQ(holder->guardian, 18);
  left.free({"shared"});
  EXPECT_EQ(live.change_to(folder_, {"b", "shared"}, holder).value(), true);
  EXPECT_TRUE(left.has("a") && !left.has("shared"));
  EXPECT_EQ(left.change_to(folder_, {"a"}, holder).value(), true);
  live.free_all();
  left.free_all();
  EXPECT_TRUE(fs::is_empty(folder_));
}

TEST_F(LockedRobot, IsAbandonedWhenAllWhoHeldItWereKilledWhileItWasDriven) {
  const auto left_by_a_dead_holder = [&](const std::string& id, LockState state) {
    StopMessages robot = robot_;
    robot.robot = id;
    const pid_t holder = ::fork();
    if (holder == 0) {
      RobotLocks locks;
      std::optional<LockHolder> nobody;
      (void)locks.change_to(folder_, {id + "-link", id + "-device"}, nobody);
      locks.write({robot, 17, ::getpid(), state});
      ::kill(::getpid(), SIGKILL);
    }
    ::waitpid(holder, nullptr, 0);
  };
  left_by_a_dead_holder("driven", LockState::Driven);
  left_by_a_dead_holder("left", LockState::Left);
  left_by_a_dead_holder("claimed", LockState::Claimed);
  left_by_a_dead_holder("rests", LockState::Rests);
  std::ofstream(folder_ + "/nonsense.lock") << "robot x\n";
  std::optional<LockHolder> nobody;
  RobotLocks living;
  ASSERT_TRUE(living.change_to(folder_, {"living"}, nobody).ok());
  living.write({robot_, 17, ::getpid(), LockState::Driven});

  const auto found = find_abandoned(folder_);
  ASSERT_EQ(found.size(), 2U) << "each once, though it has two locks";
  EXPECT_EQ(found[0].holder.robot.robot, "driven");
  EXPECT_EQ(found[0].holder.robot.body, robot_.body);
  EXPECT_EQ(found[1].holder.robot.robot, "left");
  EXPECT_NEAR(static_cast<double>(found[0].seen_unix_s), static_cast<double>(::time(nullptr)), 60.0);
  EXPECT_EQ(find_abandoned(folder_).size(), 2U) << "to look changes nothing";
  forget_abandoned(folder_, found[0].holder);
  ASSERT_EQ(find_abandoned(folder_).size(), 1U);
  forget_abandoned(folder_, found[1].holder);
  living.free_all();
  EXPECT_TRUE(fs::is_empty(folder_));
}

TEST(LockFolder, IsRefusedWhereItIsNoFolder) {
  const RuntimeFolder runtime;
  std::ofstream(runtime.path() / "tandem") << "";
  const auto folder = lock_folder();
  ASSERT_FALSE(folder.ok());
  EXPECT_NE(folder.error().message.find("not a folder of yours"), std::string::npos) << folder.error().message;
}

}  // namespace
}  // namespace tandem::bridges::guardian
