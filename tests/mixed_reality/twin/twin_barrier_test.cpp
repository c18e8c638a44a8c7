#include "mixed_reality/twin/twin_barrier.hpp"

#include <gtest/gtest.h>

#include "hal/robot/epuck.hpp"
#include "hal/robot/eyebot.hpp"

namespace tandem::mixed_reality {
namespace {

constexpr hal::TimeNs kTick = 100 * hal::kNsPerMs;

/// One robot, 1 m before a keep-out between 0.5 and 1 m of height.
class BarrierOfATwin : public testing::Test {
 protected:
  BarrierOfATwin() {
    settings_.keep_outs.push_back({"table", {{1, -2}, {3, -2}, {3, 2}, {1, 2}}, 0.5, 1.0, 0.0, 0});
    tracked_.known = true;
    tracked_.pose = core::Pose::at(0.0, 0.0, 0.0, 0.6);
  }
  template <class... Commands>
  void tick(TwinBarrier& barrier, bool hears, const Commands&... commands) {
    now_ns_ += kTick;
    tracked_.taken_ns = now_ns_;
    barrier.begin(tracked_, now_ns_, 0.0, 0.0, hears);
    (want(barrier, commands), ...);
    filter_.solve(now_ns_);
  }
  template <class Command>
  void want(TwinBarrier& barrier, const Command& command) {
    if constexpr (std::is_same_v<Command, hal::QuadrotorPosition>)
      barrier.want(command, tracked_.pose);
    else
      barrier.want(command);
  }

  core::SafetyConfig settings_;
  BarrierFilter filter_{settings_, kTick};
  TrackedPose tracked_;
  hal::TimeNs now_ns_ = hal::kNsPerSecond;
};

TEST_F(BarrierOfATwin, APlaceBehindAnEdgeBecomesANearerOne) {
  TwinBarrier barrier(filter_, hal::eyebot::kind());
  hal::QuadrotorPosition place;
  place.set(2.0, 0.3, 0.6, 1.0);
  tick(barrier, true, place);
  barrier.apply(place, tracked_.pose);
  EXPECT_LT(place.target[0], 0.9);
  EXPECT_GT(place.target[0], 0.3);
  EXPECT_NEAR(place.target[1], 0.3, 0.01);
  EXPECT_EQ(place.yaw_rad, 1.0);
  EXPECT_TRUE(barrier.changed());
}

TEST_F(BarrierOfATwin, APlaceThatTheWayIsFreeToStaysAsItIs) {
  TwinBarrier barrier(filter_, hal::eyebot::kind());
  hal::QuadrotorPosition place;
  place.set(-2.0, 0.3, 0.7, 1.0);
  tick(barrier, true, place);
  const auto wanted = place.target;
  barrier.apply(place, tracked_.pose);
  EXPECT_EQ(place.target, wanted);
  EXPECT_FALSE(barrier.changed());
}

TEST_F(BarrierOfATwin, ThePlaceRulesTheSpeedAndTheTaskBoth) {
  TwinBarrier barrier(filter_, hal::eyebot::kind());
  hal::FlightTask fly, land;
  land.order = hal::FlightOrder::Land;
  hal::QuadrotorPosition place;
  place.set(2.0, 0.0, 0.6, 0.0);
  hal::QuadrotorSpeed speed;
  speed.set(0.1, 0.0, 0.0, 0.0);
  tick(barrier, true, fly, place, speed);
  const hal::QuadrotorSpeed before = speed;
  barrier.apply(speed);
  EXPECT_EQ(speed.velocity, before.velocity);
  tick(barrier, true, land, place);
  const auto target = place.target;
  barrier.apply(place, tracked_.pose);
  EXPECT_EQ(place.target, target);
}

TEST_F(BarrierOfATwin, ATakeOffUnderAKeepOutDoesNotBegin) {
  TwinBarrier barrier(filter_, hal::eyebot::kind());
  settings_.keep_outs[0].from_m = 0.9;
  settings_.keep_outs[0].to_m = 2.0;
  hal::FlightTask task;
  task.order = hal::FlightOrder::TakeOff;
  tracked_.pose = core::Pose::at(2.0, 0.0, 0.0, 0.0);
  tick(barrier, true, task);
  barrier.apply(task);
  EXPECT_EQ(task.order, hal::FlightOrder::Fly);
  task.order = hal::FlightOrder::TakeOff;
  tracked_.pose = core::Pose::at(-2.0, 0.0, 0.0, 0.0);
  tick(barrier, true, task);
  barrier.apply(task);
  EXPECT_EQ(task.order, hal::FlightOrder::TakeOff);
}

TEST_F(BarrierOfATwin, WheelsKeepTheirTurn) {
  TwinBarrier one(filter_, hal::epuck::kind());
  TwinBarrier other(filter_, hal::epuck::kind());
  TrackedPose there = tracked_;
  there.pose = core::Pose::at(0.09, 0.0, 0.0, 0.6);
  there.taken_ns = now_ns_ + kTick;
  other.begin(there, now_ns_ + kTick, 0.0, 0.0, true);
  hal::WheelSpeeds wheels;
  wheels.set(0.08, 0.12);
  tick(one, true, wheels);
  one.apply(wheels);
  EXPECT_NEAR(wheels.right_m_s - wheels.left_m_s, 0.04, 1e-12);
  EXPECT_LT(wheels.forward_m_s(), 0.06);
  EXPECT_GE(wheels.forward_m_s(), 0.0);
  one.count();
  EXPECT_EQ(one.counts().changed_ticks, 1U);
}

TEST_F(BarrierOfATwin, ATrespassIsNotedOnceUntilItIsLeft) {
  TwinBarrier barrier(filter_, hal::eyebot::kind());
  const auto notes_at = [&](double x_m) {
    tracked_.pose = core::Pose::at(x_m, 0.0, 0.0, 0.6);
    tick(barrier, true);
    return barrier.notes_trespass();
  };
  EXPECT_FALSE(notes_at(0.0));
  EXPECT_FALSE(notes_at(0.755)) << "a touch";
  EXPECT_TRUE(notes_at(0.8));
  EXPECT_NEAR(barrier.trespass().depth_m, 0.05, 1e-9);
  EXPECT_FALSE(notes_at(0.9));
  EXPECT_FALSE(notes_at(0.7));
  EXPECT_TRUE(notes_at(0.8));
  EXPECT_EQ(barrier.counts().trespasses, 2U);
}

}  // namespace
}  // namespace tandem::mixed_reality
