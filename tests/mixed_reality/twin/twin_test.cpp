#include "mixed_reality/twin/twin.hpp"

#include <cmath>
#include <gtest/gtest.h>
#include <numbers>

#include "tests/core/space_by_hand.hpp"
#include "tests/mixed_reality/fake_robot.hpp"

namespace tandem::mixed_reality {
namespace {

using hal::port_type;
constexpr hal::TimeNs kTick = 100 * hal::kNsPerMs;

/// An arena of 2 m x 2 m with one twin at its centre, facing east; no world around it.
class TwinTest : public testing::Test {
 protected:
  void SetUp() override {
    robot_ = core::add_robot(space_, hal::epuck::kind(), "ep0", 0.0, 0.0, 0.0,
                             {&port_type<hal::Proximity>(), &port_type<hal::WheelSpeeds>(), &port_type<hal::RingLeds>(),
                              &port_type<hal::Positioning>()});
    auto real = std::make_unique<FakeRobot>(body_);
    auto poses = std::make_unique<Odometry>(
        space_.pose(robot_), *hal::epuck::kind().drive(),
        *static_cast<const hal::WheelEncoders*>(real->port(port_type<hal::WheelEncoders>())));
    TwinParams params;
    params.rearm = {.settle_s = 0.2, .ramp_m_s2 = 0.2};
    twin_ = std::make_unique<Twin>(space_, robot_, std::move(real), std::move(poses), params, log_);
  }

  /// One tick in which the controller, unless it is held, commands these speeds.
  void tick(double left_m_s, double right_m_s, RunPhase phase = RunPhase::Running) {
    now_.run_ns += kTick;
    now_.monotonic_ns += kTick;
    twin_->latch(now_, phase);
    twin_->after_sense();
    if (!space_.halted(robot_)) {
      space_.port<hal::WheelSpeeds>(robot_)->set(left_m_s, right_m_s);
      space_.port<hal::RingLeds>(robot_)->set_all(hal::kRed);
    }
    twin_->after_filter(now_);
  }
  void get_under_way(double left_m_s, double right_m_s) {
    for (int i = 0; i < 15; ++i) tick(left_m_s, right_m_s);
    ASSERT_TRUE(twin_->verdict().may_drive) << twin_->verdict().reason;
    ASSERT_EQ(body_.wheels.left_m_s, left_m_s);
  }
  void expect_twin_where_the_robot_is() {
    const core::Pose twin = space_.pose(robot_);
    EXPECT_NEAR(twin.x_m, body_.pose.x_m, 1e-9);
    EXPECT_NEAR(twin.y_m, body_.pose.y_m, 1e-9);
    EXPECT_NEAR(twin.heading_rad(), body_.pose.heading_rad(), 1e-9);
  }

  core::Space space_;
  core::RobotId robot_;
  FakeBody body_;
  hal::Log log_;
  Moment now_{0, 5'000'000'000};
  std::unique_ptr<Twin> twin_;
};

TEST_F(TwinTest, StandsWhereTheRealRobotIsAlthoughItsReadingsAreATickOld) {
  for (int i = 0; i < 100; ++i) {
    tick(0.06, 0.05);
    expect_twin_where_the_robot_is();
  }
  EXPECT_GT(std::hypot(body_.pose.x_m, body_.pose.y_m), 0.1);
}

TEST_F(TwinTest, IsExternalSoThatEnginesLeaveIt) {
  EXPECT_TRUE(space_.external(robot_));
}

TEST_F(TwinTest, WaitsBeforeTheRunAndSettlesAtItsStart) {
  for (int i = 0; i < 10; ++i) tick(0.05, 0.05, RunPhase::Waiting);
  EXPECT_TRUE(space_.halted(robot_));
  EXPECT_TRUE(body_.stands());
  tick(0.05, 0.05);
  EXPECT_EQ(twin_->verdict().reason, "settling");
  tick(0.05, 0.05);
  tick(0.05, 0.05);
  EXPECT_TRUE(twin_->verdict().may_drive);
  EXPECT_FALSE(space_.halted(robot_));
  tick(0.05, 0.05);
  EXPECT_NEAR(body_.wheels.left_m_s, 0.02, 1e-12);  // 0.2 m/s2 after 0.1 s
  EXPECT_EQ(twin_->counts().ticks_held, 2U);
}

TEST_F(TwinTest, HoldsTheControllerWhileTheLinkIsLostAndRampsUpWhenItIsBack) {
  get_under_way(0.1, 0.1);
  body_.link_up = false;
  tick(0.1, 0.1);
  EXPECT_EQ(twin_->verdict().reason, "link lost");
  EXPECT_TRUE(space_.halted(robot_));
  EXPECT_EQ(space_.port<hal::WheelSpeeds>(robot_)->left_m_s, 0.0);
  EXPECT_EQ(twin_->sent().left_m_s, 0.0);
  for (int i = 0; i < 18; ++i) tick(0.1, 0.1);
  body_.link_up = true;
  const std::size_t before = body_.received.size();
  for (int i = 0; i < 15; ++i) tick(0.1, 0.1);
  EXPECT_FALSE(space_.halted(robot_));
  double last = 0.0;  // what it heard first was to stand
  for (std::size_t i = before; i < body_.received.size(); ++i) {
    EXPECT_LE(body_.received[i].wheels.left_m_s - last, 0.2 * 0.1 + 1e-12) << i;
    last = body_.received[i].wheels.left_m_s;
  }
  EXPECT_NEAR(last, 0.1, 1e-12);
  EXPECT_EQ(twin_->counts().stops, 1U);
  EXPECT_EQ(twin_->counts().rearms, 2U);
  expect_twin_where_the_robot_is();  // it drove on while nobody could stop it, and that was rolled too
  EXPECT_GT(body_.pose.x_m, 0.2);
}

TEST_F(TwinTest, SaysSinceWhenAndWhyItStands) {
  get_under_way(0.05, 0.05);
  body_.link_up = false;
  tick(0.05, 0.05);
  EXPECT_EQ(twin_->incidents().back(), "robot 'ep0' at 1.6 s: link lost (cable out)");
}

TEST_F(TwinTest, AStalePoseStopsItAlthoughTheLinkIsWell) {
  get_under_way(0.05, 0.05);
  now_.run_ns += kTick;
  now_.monotonic_ns += 601 * hal::kNsPerMs;  // the readings are of before the hub's stall
  twin_->latch(now_, RunPhase::Running);
  EXPECT_EQ(twin_->verdict().reason, "pose stale");
  twin_->after_filter(now_);
  EXPECT_TRUE(body_.stands());
}

TEST_F(TwinTest, SendsNoCommandThatWasDecidedUponBeforeTheHubsStall) {
  get_under_way(0.05, 0.05);
  now_.run_ns += kTick;
  now_.monotonic_ns += kTick;
  twin_->latch(now_, RunPhase::Running);
  ASSERT_TRUE(twin_->verdict().may_drive);
  now_.monotonic_ns += 601 * hal::kNsPerMs;
  twin_->after_filter(now_);
  EXPECT_TRUE(body_.stands());
}

TEST_F(TwinTest, NeverWakesAControllerThatTheWorldStopped) {
  get_under_way(0.05, 0.05);
  space_.set_halted(robot_, true);
  for (int i = 0; i < 20; ++i) tick(0.05, 0.05);
  EXPECT_EQ(twin_->verdict().reason, "held by a hook");
  EXPECT_TRUE(space_.halted(robot_));
  EXPECT_TRUE(body_.stands());
}

/// A hook halts it while the twin is held for a reason of its own; that must not be forgotten when this one is gone.
class HaltedWhileHeld : public TwinTest, public testing::WithParamInterface<const char*> {};

TEST_P(HaltedWhileHeld, StaysHaltedUntilTheHookLetsItGo) {
  const std::string when = GetParam();
  if (when == "link suspect") get_under_way(0.05, 0.05);
  if (when == "link suspect") body_.health_when_up = LinkHealth::Suspect;
  if (when != "settling") tick(0.05, 0.05, when == "before the run" ? RunPhase::Waiting : RunPhase::Running);
  if (when == "settling") tick(0.05, 0.05);
  space_.set_halted(robot_, true);
  body_.health_when_up = LinkHealth::Active;
  const std::size_t heard = body_.received.size();
  for (int i = 0; i < 30; ++i) tick(0.05, 0.05);
  EXPECT_TRUE(space_.halted(robot_));
  EXPECT_EQ(twin_->verdict().reason, "held by a hook");
  for (std::size_t i = heard; i < body_.received.size(); ++i) EXPECT_EQ(body_.received[i].wheels.left_m_s, 0.0) << i;
  space_.set_halted(robot_, false);
  get_under_way(0.05, 0.05);
}
INSTANTIATE_TEST_SUITE_P(Twin, HaltedWhileHeld, testing::Values("before the run", "settling", "link suspect"));

TEST_F(TwinTest, AHookThatLetsGoDoesNotWakeAControllerThatThrew) {
  get_under_way(0.05, 0.05);
  space_.set_halted(robot_, true, core::HaltOwner::Controller);
  space_.set_halted(robot_, true);
  tick(0.05, 0.05);
  space_.set_halted(robot_, false);
  for (int i = 0; i < 20; ++i) tick(0.05, 0.05);
  EXPECT_EQ(twin_->verdict().reason, "controller failed");
  EXPECT_TRUE(body_.stands());
}

TEST_F(TwinTest, ALongOutageWaitsForAPersonWhoArmsThisRobot) {
  get_under_way(0.1, 0.1);
  body_.link_up = false;
  for (int i = 0; i < 21; ++i) tick(0.1, 0.1);
  body_.link_up = true;
  for (int i = 0; i < 100; ++i) tick(0.1, 0.1);
  EXPECT_TRUE(body_.stands());
  EXPECT_TRUE(twin_->real_robot().awaits_rearm());
  EXPECT_EQ(twin_->real_robot().state(), RobotState::Held);
  twin_->real_robot().rearm_if_proved();
  for (int i = 0; i < 100; ++i) tick(0.1, 0.1);
  EXPECT_TRUE(body_.stands());
  twin_->real_robot().rearm();
  get_under_way(0.1, 0.1);
}

TEST_F(TwinTest, AFrozenHubIsAStopThatNeedsARearm) {
  get_under_way(0.05, 0.05);
  now_.run_ns += kTick;
  now_.monotonic_ns += 3 * hal::kNsPerSecond / 2;
  twin_->latch(now_, RunPhase::Running);
  EXPECT_EQ(twin_->verdict().reason, "hub was frozen");
  twin_->after_filter(now_);
  EXPECT_TRUE(body_.stands());
  for (int i = 0; i < 18; ++i) tick(0.05, 0.05);
  EXPECT_TRUE(body_.stands());
  EXPECT_EQ(twin_->verdict().reason, "hub was frozen; waits to be re-armed");
  twin_->real_robot().rearm_if_proved();
  get_under_way(0.05, 0.05);
}

TEST_F(TwinTest, AControllerThatFailsInThisTickMovesNothingAnyMore) {
  get_under_way(0.05, 0.05);
  now_.run_ns += kTick;
  now_.monotonic_ns += kTick;
  twin_->latch(now_, RunPhase::Running);
  space_.port<hal::WheelSpeeds>(robot_)->set(0.12, 0.12);  // written before it threw
  space_.stores().blocks[0].halted[0] = core::kThrewInThisTick;
  twin_->after_filter(now_);
  EXPECT_TRUE(body_.stands());
}

TEST_F(TwinTest, LampsFollowTheControllerAndGoOutWhenItIsHeld) {
  get_under_way(0.05, 0.05);
  EXPECT_EQ(body_.leds.color(3), hal::kRed);
  body_.health_when_up = LinkHealth::Suspect;
  tick(0.05, 0.05);
  EXPECT_EQ(body_.leds.color(3), hal::kBlack);
}

TEST_F(TwinTest, ProximityIsTheNearerOfBothWorlds) {
  get_under_way(0.0, 0.0);
  auto* port = space_.port<hal::Proximity>(robot_);
  const auto sense = [&](float virtual_m, double real_m) {
    body_.real_proximity_m = real_m;
    now_.run_ns += kTick;
    now_.monotonic_ns += kTick;
    twin_->latch(now_, RunPhase::Running);
    port->validity = hal::Validity::Fresh;
    port->distance_m.fill(virtual_m);
    twin_->after_sense();
    twin_->after_filter(now_);
    return port->distance_m[3];
  };
  EXPECT_FLOAT_EQ(sense(0.1F, 0.02), 0.02F);
  EXPECT_FLOAT_EQ(sense(0.03F, 0.1), 0.03F);
}

TEST_F(TwinTest, StaysInTheArenaAndSoDoesTheRobot) {
  for (int i = 0; i < 400; ++i) {
    tick(0.1, 0.1);
    ASSERT_LE(space_.pose(robot_).x_m, 1.0);
  }
  EXPECT_LE(body_.pose.x_m, 1.0);
  EXPECT_GT(body_.pose.x_m, 0.9);
  EXPECT_GT(twin_->counts().fenced_ticks, 100U);
  for (int i = 0; i < 60; ++i) tick(-0.05, 0.05);  // it may turn there, and come back
  const double turned = body_.pose.heading_rad();
  EXPECT_GT(std::fabs(turned), 0.5);
}

TEST_F(TwinTest, ARobotCarriedOutOfTheArenaKeepsItsTwinAtTheEdge) {
  get_under_way(0.0, 0.0);
  // Pushed by hand: the wheels roll with it, 12 mm a tick.
  for (int i = 0; i < 120; ++i) {
    body_.left_m += 0.012;
    body_.right_m += 0.012;
    tick(0.0, 0.0);
  }
  EXPECT_GT(twin_->pose().x_m, 1.2);
  EXPECT_EQ(space_.pose(robot_).x_m, 1.0);
}

TEST_F(TwinTest, GoesOnSmoothlyThroughAnOutageAndComesBackWithoutAJump) {
  get_under_way(0.1, 0.1);
  double farthest_m = 0.0;
  core::Pose before = space_.pose(robot_);
  const auto watch = [&] {
    const core::Pose now = space_.pose(robot_);
    farthest_m = std::max(farthest_m, std::hypot(now.x_m - before.x_m, now.y_m - before.y_m));
    EXPECT_GE(now.x_m, before.x_m - 1e-9);  // it never jumps back
    before = now;
  };
  body_.link_up = false;
  for (int i = 0; i < 10; ++i) {
    tick(0.1, 0.1);
    watch();
    EXPECT_NEAR(space_.pose(robot_).x_m, body_.pose.x_m, 1e-9) << i;  // nobody stopped it, and the twin knows that
    EXPECT_EQ(twin_->verdict().may_drive, false);
  }
  EXPECT_NEAR(farthest_m, FakeBody::turned_m_s(0.1) * 0.1, 1e-9);
  for (int i = 0; i < 30; ++i) {
    tick(0.1, 0.1);
    watch();
  }
  EXPECT_LT(space_.pose(robot_).x_m, body_.pose.x_m - 0.1);  // it is not believed to drive for ever
  const double behind_m = body_.pose.x_m - space_.pose(robot_).x_m;
  farthest_m = 0.0;
  body_.link_up = true;
  for (int i = 0; i < 5; ++i) {
    tick(0.1, 0.1);
    watch();
  }
  EXPECT_LT(farthest_m, behind_m / 3.0 + 0.011);  // spread over 0.3 s
  expect_twin_where_the_robot_is();
}

TEST_F(TwinTest, WhatIsSafeGoesByWhereTheRobotIsNotByWhereItIsShown) {
  get_under_way(0.1, 0.1);
  body_.link_up = false;
  for (int i = 0; i < 60; ++i) tick(0.1, 0.1);
  body_.link_up = true;
  tick(0.0, 0.0);
  tick(0.0, 0.0);
  EXPECT_NEAR(twin_->pose().x_m, body_.pose.x_m, 1e-9);
  EXPECT_LT(space_.pose(robot_).x_m, body_.pose.x_m - 0.01);
}

TEST_F(TwinTest, IsToldItsPlaceByItsTwin) {
  get_under_way(0.1, 0.08);
  const auto& place = *space_.port<hal::Positioning>(robot_);
  EXPECT_EQ(place.validity, hal::Validity::Fresh);
  EXPECT_NEAR(place.p_WB[0], body_.pose.x_m, 1e-9);
  EXPECT_NEAR(place.p_WB[1], body_.pose.y_m, 1e-9);
  EXPECT_NEAR(2.0 * std::atan2(place.q_WB[3], place.q_WB[0]), body_.pose.heading_rad(), 1e-9);
  EXPECT_LE(place.taken_ns, now_.run_ns);
}

TEST_F(TwinTest, DrivesIntoAVirtualWallNoFartherAndSaysSo) {
  core::Object& wall = core::add_object(space_, core::Object::Kind::Box, 0.4, 0.0, 0.0, 0.1);
  wall.id = "wall_3";
  wall.half_x_m = 0.05;
  wall.half_y_m = 0.5;
  for (int i = 0; i < 100; ++i) tick(0.1, 0.1);
  const double touch_m = 0.35 - hal::epuck::kind().body.radius_m;
  EXPECT_GT(body_.pose.x_m, touch_m + Intrusion::kTouch_m);
  EXPECT_LT(body_.pose.x_m, touch_m + Intrusion::kTouch_m + 0.02);  // two ticks
  EXPECT_EQ(twin_->counts().intrusions, 1U);
  EXPECT_NE(twin_->incidents().back().find("its twin stands in 'wall_3'"), std::string::npos);
  EXPECT_TRUE(twin_->verdict().may_drive);
  for (int i = 0; i < 20; ++i) tick(-0.05, -0.05);  // and may come out of it
  EXPECT_LT(body_.pose.x_m, touch_m);
}

TEST_F(TwinTest, ReadingsAreNeverFromTheFutureAfterAStall) {
  get_under_way(0.05, 0.05);
  now_.monotonic_ns += 700 * hal::kNsPerMs;  // slots of the schedule were left out: the run's clock knows nothing of it
  for (int i = 0; i < 5; ++i) {
    tick(0.05, 0.05);
    const hal::TimeNs taken_ns = space_.port<hal::Proximity>(robot_)->taken_ns;
    EXPECT_LE(taken_ns, now_.run_ns);
    if (i > 0) {
      EXPECT_GE(taken_ns, now_.run_ns - kTick) << i;
    }
  }
}

}  // namespace
}  // namespace tandem::mixed_reality
