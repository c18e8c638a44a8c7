#include "mixed_reality/safety/supervised_robot.hpp"

#include <gmock/gmock.h>

#include "hal/device/wheels.hpp"

namespace tandem::mixed_reality {
namespace {

using testing::HasSubstr;

constexpr hal::TimeNs kTick = 100 * hal::kNsPerMs;

/// A bridge whose robot is what the test says.
class ScriptedBridge final : public bridges::RobotBridge, private hal::Robot {
 public:
  hal::Robot& robot() noexcept override { return *this; }
  void* port(const hal::PortType& type) noexcept override {
    if (type.layout == hal::port_type<hal::WheelSpeeds>().layout) return &wheels;
    if (type.layout == hal::port_type<hal::WheelEncoders>().layout) return &encoders;
    if (type.layout == hal::port_type<hal::Battery>().layout) return &battery;
    return nullptr;
  }
  std::vector<bridges::PortView> taken() const override { return taken_; }
  void set_origin(hal::TimeNs origin) noexcept override { origin_ns = origin; }
  void start() override {}
  void shut_down() override {}
  void latch(hal::Tick, hal::TimeNs now) noexcept override {
    encoders.validity = answers ? hal::Validity::Fresh : hal::Validity::Absent;
    encoders.taken_ns = now - 10 * hal::kNsPerMs - origin_ns;
    battery.validity = hal::Validity::Fresh;
  }
  void commit(hal::TimeNs) noexcept override { sent = wheels; }
  void stop(hal::TimeNs) noexcept override {}
  void land(hal::TimeNs) noexcept override { landing = true; }
  void resume() noexcept override { landing = false; }
  bridges::LinkHealth health() const noexcept override { return link_health; }
  bool stopped_itself() const noexcept override { return restarted; }
  bool at_rest() const noexcept override { return true; }
  std::string trouble() const override { return {}; }
  std::string advice() const override { return {}; }
  bridges::RobotIdentity identity() const override { return {.link = "fake", .device = "fake", .session = 1}; }
  bridges::StopMessages stop_messages() const override { return {}; }
  std::uint64_t stop_version() const noexcept override { return 0; }
  bridges::LinkReport report() const override { return {}; }
  void describe(bridges::StatusVisitor&) const override {}

  hal::WheelSpeeds wheels, sent;
  hal::WheelEncoders encoders;
  hal::Battery battery;
  bridges::LinkHealth link_health = bridges::LinkHealth::Active;
  bool answers = true, restarted = false, landing = false;
  hal::TimeNs origin_ns = 0;

 private:
  std::string_view id() const noexcept override { return "ep0"; }
  const hal::RobotKind& kind() const noexcept override { return kind_; }
  std::uint64_t run_seed() const noexcept override { return 0; }
  void* take(const hal::PortType& type) override {
    void* data = port(type);
    if (data == nullptr) throw hal::DeviceError("there is no " + std::string(type.name));
    taken_.push_back({&type, data});
    return data;
  }
  hal::RobotKind kind_;
  std::vector<bridges::PortView> taken_;
};

/// A robot whose controller drives with 0.1 m/s whenever it steps.
class SupervisedRobotTest : public testing::Test {
 protected:
  void SetUp() override {
    bridge_.battery.charge = 0.8F;
    auto& wheels = bridge_.robot().actuator<hal::WheelSpeeds>();
    (void)bridge_.robot().sensor<hal::WheelEncoders>();
    (void)bridge_.robot().sensor<hal::Battery>();
    wheels.set(0.1, 0.1);
    params_.rearm = {.settle_s = 0.5, .ramp_m_s2 = 0.2};
    params_.rearm.policy.after_s = 2.0;
  }
  void make() {
    robot_ = std::make_unique<SupervisedRobot>(
        "ep0", bridge_, params_,
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

  ScriptedBridge bridge_;
  SupervisedParams params_;
  std::unique_ptr<SupervisedRobot> robot_;
  std::string log_;
  hal::Tick tick_ = 0;
  hal::TimeNs now_ = 50 * hal::kNsPerSecond;
  bool stepped_ = false;
};

TEST_F(SupervisedRobotTest, SettlesThenRampsAndKeepsWhatTheControllerWrote) {
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

TEST_F(SupervisedRobotTest, RampsAfterAnOutageAndDrivesWithinASecond) {
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
  EXPECT_EQ(robot_->supervisor().stops(), 1U);
}

TEST_F(SupervisedRobotTest, IsNotArmedBeforeEveryReadingCameThatItsControllerAskedFor) {
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

TEST_F(SupervisedRobotTest, ARestartIsAStopThatNeedsAReArm) {
  params_.rearm.policy = {RearmBy::Operator, 0.0};
  get_under_way();
  bridge_.restarted = true;
  tick();
  bridge_.restarted = false;
  for (int i = 0; i < 50; ++i) tick();
  EXPECT_EQ(bridge_.sent.left_m_s, 0.0);
  EXPECT_EQ(robot_->supervisor().stops_by(StopOwner::Robot), 1U);
  EXPECT_THAT(log_, HasSubstr("waits to be re-armed"));
  robot_->rearm();
  for (int i = 0; i < 20; ++i) tick();
  EXPECT_EQ(bridge_.sent.left_m_s, 0.1);
}

TEST_F(SupervisedRobotTest, StandsForGoodOnceNobodyGuardsIt) {
  get_under_way();
  robot_->set_guarded(false);
  for (int i = 0; i < 100; ++i) {
    tick();
    EXPECT_EQ(bridge_.sent.left_m_s, 0.0);
    robot_->rearm();
  }
  EXPECT_TRUE(bridge_.landing);
  EXPECT_EQ(robot_->supervisor().stops_by(StopOwner::Guardian), 1U);
  EXPECT_THAT(log_, HasSubstr("robot 'ep0': guardian gone"));
}

TEST_F(SupervisedRobotTest, ALowBatteryStopsAndLandsItForGood) {
  get_under_way();
  bridge_.battery.charge = 0.02F;
  for (int i = 0; i < 10; ++i) tick();
  EXPECT_EQ(bridge_.sent.left_m_s, 0.1) << "a motor that starts draws it down for a moment";
  for (int i = 0; i < 20; ++i) tick();
  EXPECT_EQ(bridge_.sent.left_m_s, 0.0);
  EXPECT_TRUE(bridge_.landing);
  EXPECT_EQ(robot_->supervisor().stops_by(StopOwner::Battery), 1U);
  bridge_.battery.charge = 0.8F;
  for (int i = 0; i < 50; ++i) tick();
  EXPECT_EQ(bridge_.sent.left_m_s, 0.0);
}

TEST_F(SupervisedRobotTest, AfterAStallAgesAreRightAndNothingMovesAtOnce) {
  get_under_way();
  tick(3 * hal::kNsPerSecond);
  EXPECT_FALSE(stepped_);
  EXPECT_EQ(robot_->supervisor().stops_by(StopOwner::Hub), 1U);
  for (int i = 0; i < 5; ++i) {
    tick();
    EXPECT_EQ(tick_ * kTick - bridge_.encoders.taken_ns, 10 * hal::kNsPerMs);
  }
}

}  // namespace
}  // namespace tandem::mixed_reality
