#include "bridges/epuck/stopper.hpp"

#include <array>
#include <gtest/gtest.h>
#include <mutex>
#include <thread>

#include "tests/bridges/epuck/scripted_robot.hpp"
#include "tests/bridges/link/memory_link.hpp"

namespace tandem::bridges::epuck {
namespace {

using guardian::StopState;

/// A robot at the far end of a link, whose wheels turn as they were told.
class LivingRobot {
 public:
  LivingRobot() {
    robot_.left = 300;
    robot_.right = -300;
    thread_ = std::jthread([this](const std::stop_token& stop) { live(stop); });
  }
  LinkOpener opener() {
    return [this]() -> hal::Result<std::unique_ptr<ByteLink>> {
      const std::lock_guard lock(mutex_);
      if (++openings_ <= 2) return hal::Error{"cannot open it yet"};
      auto [near, far] = MemoryLink::make_pair();
      far_ = std::move(far);
      return std::unique_ptr<ByteLink>(std::move(near));
    };
  }
  void unplug() {
    const std::lock_guard lock(mutex_);
    far_.reset();
  }
  void be_silent(bool silent) {
    const std::lock_guard lock(mutex_);
    robot_.silent = silent;
  }
  void roll_on(bool rolls) {
    const std::lock_guard lock(mutex_);
    rolls_ = rolls;
  }
  bool stands() {
    const std::lock_guard lock(mutex_);
    return robot_.left == 0 && robot_.right == 0;
  }

 private:
  void live(const std::stop_token& stop) {
    while (!stop.stop_requested()) {
      std::this_thread::sleep_for(std::chrono::milliseconds(1));
      const std::lock_guard lock(mutex_);
      if (robot_.left != 0 || rolls_) ++robot_.encoders[0];
      if (!far_) continue;
      std::array<std::uint8_t, 256> buffer{};
      const Received got = far_->read(buffer);
      far_->write(robot_.hear(std::span(buffer).first(got.size)), 0);
    }
  }
  std::mutex mutex_;
  ScriptedRobot robot_;
  bool rolls_ = false;
  int openings_ = 0;
  std::unique_ptr<ByteLink> far_;
  std::jthread thread_;  // last: it ends first
};

StopState steps_until(EpuckStopper& stopper, StopState wanted) {
  StopState state = StopState::Unreachable;
  for (int i = 0; i < 1000 && (i == 0 || state != wanted); ++i) state = stopper.step(monotonic_ns());
  return state;
}

TEST(EpuckStopper, StopsARobotWhoseLinkOpensLate) {
  LivingRobot robot;
  EpuckStopper stopper(robot.opener(), {});
  EXPECT_EQ(stopper.step(monotonic_ns()), StopState::Unreachable);
  EXPECT_EQ(stopper.trouble(), "cannot open it yet");
  EXPECT_FALSE(robot.stands());
  EXPECT_EQ(steps_until(stopper, StopState::Confirmed), StopState::Confirmed);
  EXPECT_TRUE(robot.stands());
}

TEST(EpuckStopper, GoesOnUntilTheRobotItselfSaysThatItStands) {
  LivingRobot robot;
  robot.be_silent(true);
  EpuckStopper stopper(robot.opener(), {});
  for (int i = 0; i < 15; ++i) EXPECT_EQ(stopper.step(monotonic_ns()), StopState::Unreachable);
  EXPECT_EQ(stopper.trouble(), "it does not answer");
  EXPECT_TRUE(robot.stands());  // it hears
  robot.roll_on(true);
  robot.be_silent(false);
  EXPECT_EQ(steps_until(stopper, StopState::Stopping), StopState::Stopping);
  for (int i = 0; i < 10; ++i) EXPECT_EQ(stopper.step(monotonic_ns()), StopState::Stopping);
  robot.roll_on(false);
  EXPECT_EQ(steps_until(stopper, StopState::Confirmed), StopState::Confirmed);
}

TEST(EpuckStopper, OpensALinkAnewThatHungUp) {
  LivingRobot robot;
  robot.be_silent(true);
  EpuckStopper stopper(robot.opener(), {});
  for (int i = 0; i < 4; ++i) (void)stopper.step(monotonic_ns());
  robot.unplug();
  EXPECT_EQ(stopper.step(monotonic_ns()), StopState::Unreachable);
  EXPECT_EQ(stopper.trouble(), "the link hung up");
  robot.be_silent(false);
  EXPECT_EQ(steps_until(stopper, StopState::Confirmed), StopState::Confirmed);
}

TEST(EpuckStopper, SaysWhyALinkCannotBe) {
  const auto type = stopper_type();
  EXPECT_EQ(type.kind, "e-puck");
  StopMessages messages;
  messages.link = "serial:/dev/ttyNoSuchRobot@115200";
  const auto stopper = type.make(messages, guardian::StopCause::HubGone);
  EXPECT_EQ(stopper->step(monotonic_ns()), StopState::Unreachable);
  EXPECT_NE(stopper->trouble().find("no such device"), std::string::npos) << stopper->trouble();
}

}  // namespace
}  // namespace tandem::bridges::epuck
