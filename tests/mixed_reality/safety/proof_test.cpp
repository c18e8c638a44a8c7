// Which robot answers: what is proved, and what makes a person arm it.
#include "mixed_reality/safety/proof.hpp"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "tests/mixed_reality/safety/scripted_bridge.hpp"

namespace tandem::mixed_reality {
namespace {

using bridges::LinkHealth;
using testing::HasSubstr;
constexpr hal::TimeNs kTick = 100 * hal::kNsPerMs;

class ProofTest : public testing::Test {
 protected:
  ProofTest() {
    bridge_.who = {.link = "serial:/dev/rfcomm0@115200",
                   .device = "/dev/rfcomm0 216:0",
                   .firmware = "asercom 1",
                   .hardware = "1A",
                   .session = 1};
  }
  /// One look, after `passed`.
  Doubt look(RunPhase phase = RunPhase::Running, hal::TimeNs passed = kTick) {
    now_ += passed;
    return proof_.look(phase, bridge_, now_);
  }
  void start() {
    for (int i = 0; i < 3; ++i) ASSERT_EQ(look(RunPhase::Waiting), Doubt::None);
    ASSERT_EQ(look(), Doubt::None);
  }
  void away(hal::TimeNs for_ns) {
    bridge_.link_health = LinkHealth::Lost;
    for (hal::TimeNs t = kTick; t < for_ns; t += kTick) EXPECT_EQ(look(), Doubt::None);
    bridge_.link_health = LinkHealth::Active;
  }
  void become(void (*change)(bridges::RobotIdentity&)) {
    change(bridge_.who);
    ++bridge_.version;
  }

  ScriptedBridge bridge_;
  Proof proof_;
  hal::TimeNs now_ = 70 * hal::kNsPerSecond;
};

TEST_F(ProofTest, TheRobotThatAnswersAllTheTimeIsProved) {
  start();
  for (int i = 0; i < 100; ++i) EXPECT_EQ(look(), Doubt::None);
  EXPECT_EQ(proof_.detail(), "");
}

TEST_F(ProofTest, AnAbsenceOfTwoSecondsIsProvedAndALongerOneIsNot) {
  start();
  away(2 * hal::kNsPerSecond);
  EXPECT_EQ(look(), Doubt::None);
  away(2 * hal::kNsPerSecond + kTick);
  EXPECT_EQ(look(), Doubt::Away);
  EXPECT_EQ(look(), Doubt::None) << "a doubt is told once";
  EXPECT_THAT(proof_.detail(), HasSubstr("it was away for 2.1 s; 'asercom 1, hardware 1A' answers on /dev/rfcomm0"));
}

TEST_F(ProofTest, ADeviceThatWasOpenedAnewIsNotEvenBetweenTwoTicks) {
  start();
  become([](bridges::RobotIdentity& who) { ++who.session; });
  EXPECT_EQ(look(), Doubt::OpenedAnew);
  EXPECT_THAT(proof_.detail(), HasSubstr("its device was opened anew"));
}

TEST_F(ProofTest, AnotherWordIsAnotherRobot) {
  start();
  away(2 * kTick);
  become([](bridges::RobotIdentity& who) { who.firmware = "asercom 2"; });
  EXPECT_EQ(look(), Doubt::Another);
  EXPECT_THAT(proof_.detail(), HasSubstr("firmware: 'asercom 1' was armed, 'asercom 2' answers"));
}

TEST_F(ProofTest, OneOfTheSameNameAndFirmwareAtAnotherPortIsAnotherRobot) {
  bridge_.who.name = "marvin";
  start();
  away(2 * kTick);
  become([](bridges::RobotIdentity& who) { who.device = "/dev/rfcomm1 216:1"; });
  EXPECT_EQ(look(), Doubt::Another);
  EXPECT_THAT(proof_.detail(), HasSubstr("device: '/dev/rfcomm0 216:0' was armed, '/dev/rfcomm1 216:1' answers"));
}

TEST_F(ProofTest, OneThatTellsLessAfterAnOutageIsAnotherRobot) {
  start();
  away(2 * kTick);
  become([](bridges::RobotIdentity& who) { who.hardware.reset(); });
  EXPECT_EQ(look(), Doubt::Another);
}

TEST_F(ProofTest, WordsMayComeByAndByWhileItAnswers) {
  bridge_.who.hardware.reset();
  start();
  become([](bridges::RobotIdentity& who) { who.hardware = "1A"; });
  EXPECT_EQ(look(), Doubt::None);
  away(2 * kTick);
  become([](bridges::RobotIdentity& who) { who.hardware = "13"; });
  EXPECT_EQ(look(), Doubt::Another) << "what came counts";
}

TEST_F(ProofTest, TheStartArmsThoseThatAnswerWithinTwoSecondsOfIt) {
  bridge_.link_health = LinkHealth::Connecting;
  start();
  away(hal::kNsPerSecond);
  EXPECT_EQ(look(), Doubt::None);
  away(2 * kTick);
  EXPECT_EQ(look(), Doubt::None);
}

TEST_F(ProofTest, OneThatComesLaterWaitsForAPerson) {
  bridge_.link_health = LinkHealth::Connecting;
  start();
  away(3 * hal::kNsPerSecond);
  EXPECT_EQ(look(), Doubt::Late);
  away(2 * kTick);
  EXPECT_EQ(look(), Doubt::Late) << "nobody has armed it";
  proof_.arm();
  away(2 * kTick);
  EXPECT_EQ(look(), Doubt::None);
}

TEST_F(ProofTest, OneThatTakesAnotherOnesPlaceWasNotArmedByTheStart) {
  proof_.join_late();
  EXPECT_EQ(look(), Doubt::Late);
}

TEST_F(ProofTest, APersonArmsTheRobotThatAnswersAndNobodyElse) {
  start();
  become([](bridges::RobotIdentity& who) { who.name = "b", ++who.session; });
  EXPECT_EQ(look(), Doubt::Another);
  proof_.arm();
  away(2 * kTick);
  EXPECT_EQ(look(), Doubt::None);
  bridge_.link_health = LinkHealth::Lost;
  EXPECT_EQ(look(), Doubt::None);
  proof_.arm();  // nobody is there
  become([](bridges::RobotIdentity& who) { who.name = "c"; });
  bridge_.link_health = LinkHealth::Active;
  EXPECT_EQ(look(), Doubt::Another);
}

TEST_F(ProofTest, BeforeTheRunAllMayComeAndGo) {
  EXPECT_EQ(look(RunPhase::Waiting), Doubt::None);
  away(10 * hal::kNsPerSecond);
  become([](bridges::RobotIdentity& who) { who.firmware = "asercom 2", ++who.session; });
  EXPECT_EQ(look(RunPhase::Joining), Doubt::None);
  EXPECT_EQ(look(), Doubt::None);
}

TEST_F(ProofTest, AfterAPauseItIsTheSameIfItAnsweredAllTheTime) {
  start();
  for (int i = 0; i < 600; ++i) EXPECT_EQ(look(RunPhase::Paused), Doubt::None);
  EXPECT_EQ(look(), Doubt::None);
  EXPECT_EQ(look(RunPhase::Running, 5 * hal::kNsPerSecond), Doubt::Away) << "nobody looked";
}

}  // namespace
}  // namespace tandem::mixed_reality
