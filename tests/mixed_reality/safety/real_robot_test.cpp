#include <gmock/gmock.h>

#include "mixed_reality/safety/lone_robot.hpp"
#include "tests/mixed_reality/safety/scripted_bridge.hpp"

namespace tandem::mixed_reality {
namespace {

using testing::HasSubstr;

constexpr hal::TimeNs kTick = 100 * hal::kNsPerMs;

/// A robot whose controller drives with 0.1 m/s whenever it steps.
class LoneRobotTest : public testing::Test {
 protected:
  void SetUp() override {
    bridge_.battery.charge = 0.8F;
    auto& wheels = bridge_.robot().actuator<hal::WheelSpeeds>();
    (void)bridge_.robot().sensor<hal::WheelEncoders>();
    (void)bridge_.robot().sensor<hal::Battery>();
    wheels.set(0.1, 0.1);
    params_.rearm = {.settle_s = 0.5, .ramp_m_s2 = 0.2};
  }
  void make() {
    robot_ = std::make_unique<LoneRobot>(
        "ep0", std::move(owned_), params_, kTick,
        hal::Log([this](hal::Severity, std::string_view text) { log_ += std::string(text) + "\n"; }));
  }
  /// One tick, after `passed`.
  void tick(hal::TimeNs passed = kTick) {
    now_ += passed;
    stepped_ = robot_->latch(++tick_, now_);
    robot_->commit(now_);
  }
  void get_under_way() {
    make();
    for (int i = 0; i < 20; ++i) tick();
    ASSERT_EQ(bridge_.sent.left_m_s, 0.1);
  }

  std::unique_ptr<ScriptedBridge> owned_ = std::make_unique<ScriptedBridge>();
  ScriptedBridge& bridge_ = *owned_;
  RealRobotParams params_;
  std::unique_ptr<LoneRobot> robot_;
  std::string log_;
  hal::Tick tick_ = 0;
  hal::TimeNs now_ = 50 * hal::kNsPerSecond;
  bool stepped_ = false;
};

TEST_F(LoneRobotTest, SettlesThenRampsAndKeepsWhatTheControllerWrote) {
  make();
  for (int i = 0; i < 5; ++i) {
    tick();
    EXPECT_FALSE(stepped_);
    EXPECT_EQ(bridge_.sent.left_m_s, 0.0);
    EXPECT_EQ(bridge_.wheels.left_m_s, 0.1);
  }
  double last = 0.0;
  for (int i = 0; i < 10; ++i) {
    tick();
    EXPECT_TRUE(stepped_);
    EXPECT_LE(bridge_.sent.left_m_s - last, 0.2 * 0.1 + 1e-9);
    last = bridge_.sent.left_m_s;
    EXPECT_EQ(bridge_.wheels.left_m_s, 0.1);
  }
  EXPECT_EQ(last, 0.1);
}

TEST_F(LoneRobotTest, RampsAfterAnOutageAndDrivesWithinASecond) {
  get_under_way();
  bridge_.link_health = bridges::LinkHealth::Lost;
  for (int i = 0; i < 10; ++i) {
    tick();
    EXPECT_EQ(bridge_.sent.left_m_s, 0.0);
  }
  bridge_.link_health = bridges::LinkHealth::Active;
  int ticks = 0;
  while (bridge_.sent.left_m_s == 0.0 && ticks < 20) {
    tick();
    ++ticks;
  }
  EXPECT_LE(ticks, 10);
  EXPECT_LE(bridge_.sent.left_m_s, 0.2 * 0.1 + 1e-9);
  EXPECT_EQ(robot_->real().supervisor().stops(), 1U);
}

TEST_F(LoneRobotTest, IsNotArmedBeforeEveryReadingCameThatItsControllerAskedFor) {
  bridge_.answers = false;
  make();
  for (int i = 0; i < 20; ++i) tick();
  EXPECT_FALSE(stepped_);
  EXPECT_THAT(robot_->reason(), HasSubstr("a reading never came (" + std::string(hal::WheelEncoders::kName) + ")"));
  bridge_.answers = true;
  for (int i = 0; i < 10; ++i) tick();
  EXPECT_TRUE(stepped_);
  bridge_.answers = false;  // once is enough: it goes stale, and its controller knows
  tick();
  EXPECT_TRUE(stepped_);
}

TEST_F(LoneRobotTest, ARestartIsAStopThatNeedsAReArm) {
  params_.rearm.policy = {RearmBy::Time, 0.5};
  get_under_way();
  bridge_.restarted = true;
  tick();
  bridge_.restarted = false;
  for (int i = 0; i < 50; ++i) tick();
  EXPECT_EQ(bridge_.sent.left_m_s, 0.0);
  EXPECT_EQ(robot_->real().supervisor().stops_by(StopOwner::Robot), 1U);
  EXPECT_THAT(log_, HasSubstr("waits to be re-armed"));
  robot_->real().rearm();
  for (int i = 0; i < 20; ++i) tick();
  EXPECT_EQ(bridge_.sent.left_m_s, 0.1);
}

TEST_F(LoneRobotTest, AnotherRobotOnItsDeviceStandsUntilAPersonHasSeenWhichOneItIs) {
  params_.rearm.policy = {RearmBy::Time, 0.5};
  bridge_.who.firmware = "asercom 1";
  get_under_way();
  bridge_.link_health = bridges::LinkHealth::Lost;
  tick();
  bridge_.link_health = bridges::LinkHealth::Active;
  bridge_.who.firmware = "asercom 2";
  ++bridge_.version;
  for (int i = 0; i < 100; ++i) {
    tick();
    EXPECT_EQ(bridge_.sent.left_m_s, 0.0);
    robot_->real().rearm_if_proved();
  }
  EXPECT_THAT(log_, HasSubstr("another robot answers; waits to be re-armed (firmware: 'asercom 1' was armed, 'asercom "
                              "2' answers; 'asercom 2' answers on fake)"));
  robot_->real().rearm();
  for (int i = 0; i < 20; ++i) tick();
  EXPECT_EQ(bridge_.sent.left_m_s, 0.1);
}

TEST_F(LoneRobotTest, AnEmergencyStopEndsForAllAtOnceButNotForAnotherRobot) {
  get_under_way();
  robot_->real().emergency_stop(now_);
  EXPECT_TRUE(bridge_.landing) << "at once, between two ticks";
  tick();
  bridge_.who.session = 2;
  ++bridge_.version;
  tick();
  robot_->real().arm(false);
  for (int i = 0; i < 50; ++i) tick();
  EXPECT_EQ(bridge_.sent.left_m_s, 0.0);
  robot_->real().rearm();
  for (int i = 0; i < 20; ++i) tick();
  EXPECT_EQ(bridge_.sent.left_m_s, 0.1);
}

TEST_F(LoneRobotTest, StandsForGoodOnceNobodyGuardsIt) {
  get_under_way();
  robot_->real().set_guarded(false);
  for (int i = 0; i < 100; ++i) {
    tick();
    EXPECT_EQ(bridge_.sent.left_m_s, 0.0);
    robot_->real().rearm();
  }
  EXPECT_TRUE(robot_->real().verdict().land);
  EXPECT_EQ(robot_->real().supervisor().stops_by(StopOwner::Guardian), 1U);
  EXPECT_THAT(log_, HasSubstr("robot 'ep0': guardian gone"));
}

TEST_F(LoneRobotTest, ALowBatteryStopsAndLandsItForGood) {
  get_under_way();
  bridge_.battery.charge = 0.02F;
  for (int i = 0; i < 10; ++i) tick();
  EXPECT_EQ(bridge_.sent.left_m_s, 0.1) << "a motor that starts draws it down for a moment";
  for (int i = 0; i < 20; ++i) tick();
  EXPECT_EQ(bridge_.sent.left_m_s, 0.0);
  EXPECT_TRUE(robot_->real().verdict().land);
  EXPECT_EQ(robot_->real().supervisor().stops_by(StopOwner::Battery), 1U);
  bridge_.battery.charge = 0.8F;
  for (int i = 0; i < 50; ++i) tick();
  EXPECT_EQ(bridge_.sent.left_m_s, 0.0);
}

TEST_F(LoneRobotTest, AfterAStallAgesAreRightAndNothingMovesAtOnce) {
  get_under_way();
  tick(3 * hal::kNsPerSecond);
  EXPECT_FALSE(stepped_);
  EXPECT_EQ(robot_->real().supervisor().stops_by(StopOwner::Hub), 1U);
  for (int i = 0; i < 5; ++i) {
    tick();
    EXPECT_EQ(tick_ * kTick - bridge_.encoders.taken_ns, 10 * hal::kNsPerMs);
  }
}

}  // namespace
}  // namespace tandem::mixed_reality
