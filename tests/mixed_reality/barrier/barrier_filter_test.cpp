#include "mixed_reality/barrier/barrier_filter.hpp"

#include <cmath>
#include <gtest/gtest.h>
#include <limits>
#include <numbers>

#include "hal/robot/epuck.hpp"
#include "hal/robot/eyebot.hpp"
#include "hal/robot/footbot.hpp"

namespace tandem::mixed_reality {
namespace {

constexpr double kPi = std::numbers::pi;
constexpr hal::TimeNs kTick = 100 * hal::kNsPerMs;
const double kR = hal::footbot::kind().body.radius_m;

/// Robots whose poses are of now and exact, and which obey at once.
class Filter : public testing::Test {
 protected:
  BarrierRobot& robot(double x_m, double y_m, double heading_rad, const hal::RobotKind& kind = hal::footbot::kind(),
                      double z_m = 0.0) {
    BarrierRobot& made = filter_.add(kind);
    made.placed = true;
    made.pose = hal::Pose::at(x_m, y_m, heading_rad, z_m);
    made.latency_s = 0.05;
    all_.push_back(&made);
    return made;
  }
  void solve() {
    for (BarrierRobot* r : all_) r->pose_ns = now_ns_;
    filter_.solve(now_ns_);
  }
  /// Ticks in which robots do exactly what they may.
  void drive(int ticks) {
    for (int i = 0; i < ticks; ++i) {
      solve();
      now_ns_ += kTick;
      for (BarrierRobot* r : all_) {
        r->note_sent(now_ns_ - kTick, r->allowed);
        const double way_m = r->flies ? 0.0 : 0.1 * r->allowed.velocity[0];
        const double heading_rad = r->pose.heading_rad() + 0.1 * r->allowed.turn_rad_s;
        r->pose = hal::Pose::at(r->pose.x_m + way_m * r->pose.cos_h, r->pose.y_m + way_m * r->pose.sin_h, heading_rad,
                                r->pose.z_m);
        if (!r->flies) continue;
        r->pose.x_m += 0.1 * r->allowed.velocity[0];
        r->pose.y_m += 0.1 * r->allowed.velocity[1];
        r->pose.z_m += 0.1 * r->allowed.velocity[2];
      }
    }
  }
  void area(std::vector<core::SafetyArea>& list, std::vector<core::Point2> corners, double from_m = 0.0,
            double to_m = 1000.0, double max_speed_m_s = 0.0) {
    list.push_back({"area", std::move(corners), from_m, to_m, max_speed_m_s, 0});
  }

  core::SafetyConfig settings_;
  BarrierFilter filter_{settings_, kTick};
  std::vector<BarrierRobot*> all_;
  hal::TimeNs now_ns_ = 10 * hal::kNsPerSecond;
};

Motion forward(double v_m_s, double turn_rad_s = 0.0) {
  return {{v_m_s, 0.0, 0.0}, turn_rad_s};
}

TEST_F(Filter, LeavesCommandsOfRobotsThatAreFarApartAsTheyAre) {
  robot(0.0, 0.0, 0.0).wanted = forward(0.3, 1.0);
  robot(2.0, 0.0, kPi).wanted = forward(0.3, -1.0);
  solve();
  for (const BarrierRobot* r : all_) {
    EXPECT_EQ(r->allowed, r->wanted);
    EXPECT_EQ(r->changed_m_s, 0.0);
  }
}

TEST_F(Filter, RobotsThatMeetHeadOnStopApartEachDoingItsHalf) {
  robot(0.0, 0.0, 0.0).wanted = forward(0.3);
  robot(2.0, 0.0, kPi).wanted = forward(0.3);
  drive(100);
  const double gap_m = all_[1]->pose.x_m - all_[0]->pose.x_m - 2.0 * kR;
  EXPECT_GE(gap_m, settings_.apart_m - 1e-9);
  EXPECT_LT(gap_m, settings_.apart_m + 0.01);
  EXPECT_NEAR(all_[0]->pose.x_m, 2.0 - all_[1]->pose.x_m, 1e-6);
}

TEST_F(Filter, RobotsThatStandHeadOnTurnAsTheyWantAndDriveOn) {
  robot(0.0, 0.0, 0.0).wanted = forward(0.3);
  robot(1.0, 0.0, kPi).wanted = forward(0.3);
  drive(60);
  for (BarrierRobot* r : all_) r->wanted = forward(0.15, 1.0);
  solve();
  for (const BarrierRobot* r : all_) EXPECT_EQ(r->allowed.turn_rad_s, 1.0);
  drive(30);
  for (const BarrierRobot* r : all_) EXPECT_EQ(r->allowed, r->wanted) << "they left";
}

TEST_F(Filter, ARobotThatStandsLeavesAllOfTheRoomToTheOther) {
  robot(0.0, 0.0, 0.0).wanted = forward(0.2);
  robot(2.0 * kR + settings_.apart_m + 0.08, 0.0, 0.0).wanted = forward(0.0);
  solve();
  // 0.2 m/s for 0.1 s to the next tick, 10 ms late, 50 ms on the way, 200 ms to settle.
  EXPECT_EQ(all_[0]->allowed, forward(0.2));
  all_[1]->pose.x_m -= 0.02;
  solve();
  EXPECT_NEAR(all_[0]->allowed.velocity[0], 0.06 / 0.36, 1e-9);
  EXPECT_NEAR(all_[0]->changed_m_s, 0.2 - 0.06 / 0.36, 1e-9);
}

TEST_F(Filter, ARobotThatDoesNotHearIsGivenWayTo) {
  BarrierRobot& deaf = robot(0.0, 0.0, 0.0);
  deaf.wanted = forward(0.2);
  deaf.hears = false;
  deaf.note_sent(now_ns_ - kTick, forward(0.2));
  robot(2.0 * kR + 0.1, 0.0, kPi).wanted = forward(0.2);
  solve();
  EXPECT_EQ(deaf.allowed, deaf.wanted);
  EXPECT_NEAR(all_[1]->allowed.velocity[0], (0.1 - settings_.apart_m - 0.2 * 0.36) / 0.36, 1e-9);
}

TEST_F(Filter, RobotsThatStandTooNearMayLeaveOneAnotherOnly) {
  robot(0.0, 0.0, 0.0).wanted = forward(0.2);
  robot(2.0 * kR - 0.01, 0.0, 0.0).wanted = forward(0.2);
  solve();
  EXPECT_EQ(all_[0]->allowed.velocity[0], 0.0);
  EXPECT_EQ(all_[1]->allowed.velocity[0], 0.2);
  all_[0]->wanted = forward(-0.2);
  solve();
  EXPECT_EQ(all_[0]->allowed.velocity[0], -0.2);
}

TEST_F(Filter, DoesNotAvoidWhereItIsNotAsked) {
  settings_.avoid = core::Avoid::Nobody;
  robot(0.0, 0.0, 0.0).wanted = forward(0.3);
  robot(2.0 * kR, 0.0, kPi).wanted = forward(0.3);
  solve();
  EXPECT_EQ(all_[0]->allowed, forward(0.3));
}

TEST_F(Filter, UncertaintyLatencyAndAgeOfAPoseKeepItFartherAway) {
  BarrierRobot& r = robot(0.0, 0.0, 0.0);
  r.wanted = forward(0.2);
  r.obstacles.push_back({0.15, 0.0, 0.0, {}});
  solve();
  const double sure = r.allowed.velocity[0];
  r.error_m = 0.01;
  solve();
  const double unsure = r.allowed.velocity[0];
  r.error_m = 0.0;
  r.latency_s = 0.2;
  solve();
  const double late = r.allowed.velocity[0];
  r.latency_s = 0.05;
  r.note_sent(now_ns_ - kTick, forward(0.2));
  r.pose_ns = now_ns_ - kTick;
  filter_.solve(now_ns_);
  const double old = r.allowed.velocity[0];
  EXPECT_LT(unsure, sure);
  EXPECT_LT(late, sure);
  EXPECT_LT(old, sure);
}

TEST_F(Filter, AFenceStopsTheWholeBodyAndOutsideOnlyTheWayBackIsOpen) {
  area(settings_.fences, {{-1, -1}, {1, -1}, {1, 1}, {-1, 1}});
  BarrierRobot& r = robot(0.0, 0.0, 0.0);
  r.wanted = forward(0.3);
  drive(100);
  EXPECT_LE(r.pose.x_m, 1.0 - kR - settings_.apart_m + 1e-9);
  EXPECT_GT(r.pose.x_m, 1.0 - kR - settings_.apart_m - 0.01);
  EXPECT_EQ(r.trespass.area, nullptr);
  drive(10);
  r.pose.x_m = 1.2;
  solve();
  ASSERT_EQ(r.trespass.area, &settings_.fences[0]);
  EXPECT_TRUE(r.trespass.out_of_fence);
  EXPECT_NEAR(r.trespass.depth_m, 0.2 + kR, 1e-9);
  EXPECT_EQ(r.allowed.velocity[0], 0.0);
  r.wanted = forward(-0.1);
  solve();
  EXPECT_EQ(r.allowed.velocity[0], -0.1);
}

TEST_F(Filter, AKeepOutIsPassedOverAndUnderByHeight) {
  area(settings_.keep_outs, {{0.3, -1}, {1, -1}, {1, 1}, {0.3, 1}}, 0.2, 1.0);
  BarrierRobot& under = robot(0.0, 0.0, 0.0);  // 15 cm high
  BarrierRobot& beside = robot(0.0, 0.0, 0.0, hal::eyebot::kind(), 0.5);
  BarrierRobot& over = robot(0.5, 0.0, 0.0, hal::eyebot::kind(), 1.1);
  settings_.avoid = core::Avoid::Nobody;
  under.wanted = forward(0.3);
  beside.wanted = {{0.5, 0.2, 0.0}, 0.0};
  over.wanted = {{0.5, 0.0, -0.5}, 0.0};
  solve();
  EXPECT_EQ(under.allowed, under.wanted);
  EXPECT_LT(beside.allowed.velocity[0], 0.06);
  EXPECT_EQ(beside.allowed.velocity[1], 0.2) << "it slides along";
  EXPECT_EQ(over.allowed.velocity[0], 0.5);
  EXPECT_GT(over.allowed.velocity[2], -0.15);
  drive(60);
  EXPECT_GE(over.pose.x_m > 1.0 ? 1.0 : over.pose.z_m, 1.0);
}

TEST_F(Filter, AZoneIsEnteredAtItsSpeed) {
  area(settings_.zones, {{1, -1}, {2, -1}, {2, 1}, {1, 1}}, 0.0, 1.0, 0.05);
  BarrierRobot& r = robot(0.0, 0.0, 0.0);
  r.wanted = forward(0.3);
  for (int i = 0; i < 80; ++i) {
    drive(1);
    const double rim_m = r.pose.x_m + kR;
    EXPECT_TRUE(rim_m <= 1.0 || r.allowed.velocity[0] <= 0.05 + 1e-9) << rim_m;
    EXPECT_TRUE(rim_m >= 0.85 || r.allowed.velocity[0] == 0.3) << rim_m;
  }
  EXPECT_GT(r.pose.x_m + kR, 1.0) << "it does enter";
}

TEST_F(Filter, WhatIsNoNumberStands) {
  const double nan = std::numeric_limits<double>::quiet_NaN();
  BarrierRobot& r = robot(0.0, 0.0, 0.0);
  BarrierRobot& other = robot(0.5, 0.0, kPi);
  r.wanted = forward(nan);
  other.wanted = forward(0.1);
  solve();
  EXPECT_EQ(r.allowed, Motion{});
  EXPECT_EQ(other.allowed, forward(0.1));
  r.wanted = forward(0.1);
  r.pose.x_m = nan;
  solve();
  EXPECT_EQ(r.allowed, Motion{});
  EXPECT_EQ(other.allowed, forward(0.1));
}

TEST_F(Filter, FlightsOneAboveTheOtherKeepTheirHeights) {
  BarrierRobot& low = robot(0.0, 0.0, 0.0, hal::eyebot::kind(), 0.2);
  BarrierRobot& high = robot(0.1, 0.0, 0.0, hal::eyebot::kind(), 1.2);
  low.wanted.velocity = {0.1, 0.1, 0.5};
  high.wanted.velocity = {0.1, 0.1, -0.5};
  drive(50);
  EXPECT_GE(high.pose.z_m - low.pose.z_m, hal::eyebot::kind().body.height_m + settings_.apart_m - 1e-9);
  EXPECT_GT(low.pose.x_m, 0.4);
}

}  // namespace
}  // namespace tandem::mixed_reality
