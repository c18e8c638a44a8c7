#include "bridges/guardian/robot_lock.hpp"

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
  std::string key_ = lock_key(robot_);
  std::optional<LockHolder> seen_;
};

TEST_F(LockedRobot, IsNotTakenTwiceAndNamesItsHolder) {
  const auto lock = take();
  ASSERT_TRUE(lock);
  EXPECT_FALSE(seen_);
  lock->write({robot_, 17, 18, true});
  lock->write({robot_, 17, 18, false});
  EXPECT_FALSE(take());
  ASSERT_TRUE(seen_);
  EXPECT_EQ(seen_->robot, robot_);
  EXPECT_EQ(seen_->hub, 17);
  EXPECT_EQ(seen_->guardian, 18);
  EXPECT_FALSE(seen_->left);
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
    lock->write({robot_, 1, ::getpid(), false});
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

TEST_F(LockedRobot, IsTheSameUnderAnotherNameOfItsDevice) {
  const fs::path device = runtime_.path() / "ttyUSB7", alias = runtime_.path() / "by-id";
  std::ofstream(device) << "";
  fs::create_symlink(device, alias);
  const auto key = [](const std::string& link, const std::string& name = "") {
    StopMessages robot;
    robot.link = link;
    robot.name = name;
    return lock_key(robot);
  };
  EXPECT_EQ(key("serial:" + device.string() + "@115200"), key("serial:" + alias.string()));
  EXPECT_NE(key("serial:/dev/rfcomm0"), key("serial:/dev/rfcomm1"));
  EXPECT_NE(key("lcm:udpm://239.255.76.67:7667", "eb0"), key("lcm:udpm://239.255.76.67:7667", "eb1"));
  EXPECT_NE(key("tcp:a:33333"), key("tcp:b:33333"));
  EXPECT_EQ(key("tcp:" + std::string(4000, '/')).find('/'), std::string::npos);
  EXPECT_LT(key("tcp:" + std::string(4000, '/')).size(), 220U);
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
