// The twin of a robot that flies: its fence has a ceiling, its battery brings it down, places that cannot be stop it.
#include <gtest/gtest.h>

#include "core/space/stores.hpp"
#include "hal/robot/eyebot.hpp"
#include "mixed_reality/tracking/positioned.hpp"
#include "mixed_reality/twin/twin.hpp"
#include "tests/core/space_by_hand.hpp"

namespace tandem::mixed_reality {
namespace {

using hal::port_type;
constexpr hal::TimeNs kTick = 100 * hal::kNsPerMs;

/// What the robot is, and what it heard.
struct Flyer {
  std::array<double, 3> p_m{};
  float charge = 1.0F;
  hal::QuadrotorSpeed speed;
  hal::QuadrotorPosition position;
  hal::FlightTask task;
};

class FakeFlyer final : public bridges::RobotBridge, private hal::Robot {
 public:
  explicit FakeFlyer(Flyer& body) : body_(body) {}

  hal::Robot& robot() noexcept override { return *this; }
  void* port(const hal::PortType& type) noexcept override {
    if (type.layout == port_type<hal::Positioning>().layout) return &places_;
    if (type.layout == port_type<hal::Battery>().layout) return &battery_;
    if (type.layout == port_type<hal::QuadrotorSpeed>().layout) return &body_.speed;
    if (type.layout == port_type<hal::QuadrotorPosition>().layout) return &body_.position;
    if (type.layout == port_type<hal::FlightTask>().layout) return &body_.task;
    return nullptr;
  }
  std::vector<bridges::PortView> taken() const override { return {}; }
  void set_origin(hal::TimeNs origin_ns) noexcept override { origin_ns_ = origin_ns; }
  void start() override {}
  void shut_down() override {}
  void latch(hal::Tick, hal::TimeNs now) noexcept override {
    battery_.charge = body_.charge;
    battery_.validity = hal::Validity::Fresh;
    places_.p_WB = body_.p_m;
    places_.taken_ns = now - origin_ns_;
    places_.validity = hal::Validity::Fresh;
  }
  void commit(hal::TimeNs) noexcept override {}
  void stop(hal::TimeNs) noexcept override {}
  void resume() noexcept override {}
  LinkHealth health() const noexcept override { return LinkHealth::Active; }
  bool at_rest() const noexcept override { return true; }
  std::string trouble() const override { return ""; }
  std::string advice() const override { return ""; }
  bridges::RobotIdentity identity() const override { return {.link = "fake", .device = "fake", .session = 1}; }
  bridges::StopMessages stop_messages() const override { return {}; }
  std::uint64_t stop_version() const noexcept override { return 1; }
  bridges::LinkReport report() const override { return {}; }
  void describe(bridges::StatusVisitor&) const override {}

 private:
  std::string_view id() const noexcept override { return "fake"; }
  const hal::RobotKind& kind() const noexcept override { return hal::eyebot::kind(); }
  std::uint64_t run_seed() const noexcept override { return 0; }
  void* take(const hal::PortType& type) override { return port(type); }

  Flyer& body_;
  hal::TimeNs origin_ns_ = 0;
  hal::Positioning places_;
  hal::Battery battery_;
};

/// An arena of 4 m x 4 m, 2 m high.
class FlyingTwin : public testing::Test {
 protected:
  FlyingTwin() {
    core::SpaceStores& s = space_.stores();
    s.min_x_m = s.min_y_m = -2.0;
    s.max_x_m = s.max_y_m = 2.0;
    s.max_z_m = 2.0;
    s.bodies.has_motion = true;
    robot_ = core::add_robot(space_, hal::eyebot::kind(), "eb0", 0.0, 0.0, 0.0,
                             {&port_type<hal::QuadrotorSpeed>(), &port_type<hal::QuadrotorPosition>()});
    body_.p_m = {0.0, 0.0, 1.0};
    auto real = std::make_unique<FakeFlyer>(body_);
    auto poses = std::make_unique<Positioned>(
        space_.pose(robot_), *static_cast<const hal::Positioning*>(real->port(port_type<hal::Positioning>())),
        hal::eyebot::kind());
    twin_ = std::make_unique<Twin>(space_, robot_, std::move(real), std::move(poses), TwinParams{}, log_);
    tick(RunPhase::Waiting);
  }
  void tick(RunPhase phase = RunPhase::Running) {
    now_.run_ns += kTick;
    now_.monotonic_ns += kTick;
    twin_->latch(now_, phase);
    twin_->after_sense();
    if (command && !space_.halted(robot_)) command();
    twin_->after_filter(now_);
  }
  void ticks(int count) {
    for (int i = 0; i < count; ++i) tick();
  }

  core::Space space_;
  core::RobotId robot_;
  Flyer body_;
  hal::Log log_;
  Moment now_{0, 5'000'000'000};
  std::unique_ptr<Twin> twin_;
  std::function<void()> command;
};

TEST_F(FlyingTwin, ARobotAboveTheArenaIsBroughtBack) {
  ticks(10);
  body_.p_m[2] = 1.2;
  ticks(1);
  for (int i = 0; i < 100; ++i) {
    body_.p_m[2] += 0.018;
    tick();
  }
  ASSERT_NEAR(body_.p_m[2], 3.0, 0.01);
  EXPECT_TRUE(twin_->verdict().may_drive);
  EXPECT_EQ(body_.speed.velocity[2], -hal::QuadrotorSpeed::kSinkIntoFence_m_s);
  EXPECT_LE(space_.pose(robot_).z_m, 2.0);
  EXPECT_GT(twin_->counts().fenced_ticks, 0U);
}

TEST_F(FlyingTwin, DoesNotRiseThroughTheCeilingNorLeaveWithItsRim) {
  command = [this] { space_.port<hal::QuadrotorPosition>(robot_)->set(5.0, 0.0, 5.0, 0.0); };
  ticks(400);
  EXPECT_NEAR(body_.position.target[2], 2.0 - hal::eyebot::kind().body.height_m, 1e-9);
  EXPECT_NEAR(body_.position.target[0], 2.0 - hal::eyebot::kind().body.radius_m, 1e-9);
}

TEST_F(FlyingTwin, ATargetFarAwayIsApproachedOnTheRamp) {
  command = [this] { space_.port<hal::QuadrotorPosition>(robot_)->set(1.0, 0.0, 1.0, 0.0); };
  while (!twin_->verdict().may_drive) tick();
  double before = 0.0;
  for (int i = 1; i < 20; ++i) {
    tick();
    EXPECT_NEAR(body_.position.target[0] - before, 0.025, 1e-9) << i;  // 0.25 m/s2, and 1 s to get there
    before = body_.position.target[0];
  }
}

TEST_F(FlyingTwin, ALowBatteryBringsItDownOneBadReadingDoesNot) {
  ticks(10);
  body_.charge = 0.0F;
  tick();
  body_.charge = 1.0F;
  ticks(5);
  EXPECT_TRUE(twin_->verdict().may_drive);
  body_.charge = 0.03F;
  ticks(22);
  EXPECT_EQ(twin_->verdict().reason, "battery low");
  EXPECT_EQ(body_.task.order, hal::FlightOrder::Land);
  body_.charge = 0.2F;
  ticks(100);
  EXPECT_EQ(body_.task.order, hal::FlightOrder::Land);
  EXPECT_FALSE(twin_->verdict().may_drive);
}

TEST_F(FlyingTwin, APlaceThatItCannotHaveReachedIsAStopThatNeedsARearm) {
  ticks(10);
  ASSERT_TRUE(twin_->verdict().may_drive);
  body_.p_m[0] = -1.9;  // a tracker that takes it for another one
  ticks(2);
  EXPECT_NEAR(twin_->pose().x_m, 0.0, 1e-9);
  ticks(10);
  EXPECT_NEAR(twin_->pose().x_m, -1.9, 1e-9);
  EXPECT_FALSE(twin_->verdict().may_drive);
  EXPECT_EQ(twin_->verdict().reason, "moved by something else; waits to be re-armed");
}

}  // namespace
}  // namespace tandem::mixed_reality
