#include "mixed_reality/barrier/motion_bound.hpp"

#include <cmath>
#include <gtest/gtest.h>
#include <numbers>

#include "hal/robot/eyebot.hpp"
#include "hal/robot/footbot.hpp"

namespace tandem::mixed_reality {
namespace {

constexpr hal::TimeNs kMs = hal::kNsPerMs;
constexpr std::array<double, 3> kEast{1.0, 0.0, 0.0};

Motion forward(double v_m_s, double turn_rad_s = 0.0) {
  return {{v_m_s, 0.0, 0.0}, turn_rad_s};
}

/// Looks east from a robot that faces `heading_rad`, told things in the past; 100 ms ticks, 250 ms to react.
MotionBound bound_of(const CommandTrail& trail, double heading_rad = 0.0, double turn_rad_s = 0.0,
                     hal::TimeNs pose_age_ns = 0) {
  MotionBound bound;
  bound.begin(trail, {1000 * kMs - pose_age_ns, 1000 * kMs, 100 * kMs, 0.25}, true);
  bound.turn(hal::Pose::at(0.0, 0.0, heading_rad), 0.0, turn_rad_s);
  bound.look(kEast);
  return bound;
}

TEST(MotionBound, ARobotThatStoodStaysWhereItIsToldNothing) {
  EXPECT_EQ(bound_of({}).way_m(0.0), 0.0);
}

TEST(MotionBound, ACommandMovesItUntilItHasReactedToTheNext) {
  const MotionBound bound = bound_of({});
  EXPECT_NEAR(bound.way_m(0.2), 0.2 * 0.35, 1e-12);
  EXPECT_NEAR(bound.way_m(-0.2), 0.0, 1e-12);
  EXPECT_NEAR(bound_of({}, std::numbers::pi).way_m(-0.2), 0.2 * 0.35, 1e-12);
  EXPECT_NEAR(bound_of({}, std::numbers::pi / 3).way_m(0.2), 0.1 * 0.35, 1e-12);
}

TEST(MotionBound, WhatItWasToldBeforeStillMovesIt) {
  CommandTrail trail;
  trail.note(0, forward(0.3));
  EXPECT_NEAR(bound_of(trail).way_m(0.0), 0.3 * 0.25, 1e-12);
  trail.note(900 * kMs, forward(0.0));
  EXPECT_NEAR(bound_of(trail).way_m(0.0), 0.3 * 0.15, 1e-12);
  EXPECT_NEAR(bound_of(trail).way_m(0.1), 0.3 * 0.15 + 0.1 * 0.2, 1e-12);
  EXPECT_NEAR(bound_of(trail, 0.0, 0.0, 200 * kMs).way_m(0.0), 0.3 * 0.35, 1e-12) << "since its pose was taken";
}

TEST(MotionBound, ItsHeadingMayHaveTurnedMeanwhile) {
  const double quarter = std::numbers::pi / 2;
  EXPECT_NEAR(bound_of({}, quarter).way_m(0.2), 0.0, 1e-12);
  EXPECT_GT(bound_of({}, quarter, -1.0).way_m(0.2), 0.01);
  EXPECT_NEAR(bound_of({}, quarter, 1.0).way_m(0.2), 0.0, 1e-12);
  EXPECT_NEAR(bound_of({}, quarter, -30.0).way_m(0.2), 0.2 * 0.35, 1e-12);
}

TEST(MotionBound, TheMostThatFitsIsExact) {
  CommandTrail trail;
  trail.note(0, forward(0.1));
  trail.note(900 * kMs, forward(0.05));
  const MotionBound bound = bound_of(trail);
  for (const double budget_m : {0.03, 0.035, 0.04, 0.05, 0.08}) {
    const double most = bound.most_m_s(0.3, budget_m);
    EXPECT_NEAR(bound.way_m(most), budget_m, 1e-9);
    EXPECT_GT(most, 0.0);
  }
  EXPECT_EQ(bound.most_m_s(0.3, 0.2), 0.3);
  EXPECT_EQ(bound.most_m_s(0.3, 0.001), 0.0);
  EXPECT_EQ(bound.most_m_s(-0.3, 0.05), -0.3) << "it leaves";
}

TEST(MotionBound, KindsSayHowFastTheySettle) {
  EXPECT_NEAR(motion_limits(hal::footbot::kind()).settle_s, 0.2, 1e-9);
  EXPECT_NEAR(motion_limits(hal::eyebot::kind()).settle_s, 2.0 / 3.0 + 0.03, 1e-9);
}

TEST(CommandTrail, MergesTheOldestAndForgetsWhatIsOver) {
  CommandTrail trail;
  for (int i = 0; i < 200; ++i) trail.note(i * kMs, forward(0.001 * i));
  EXPECT_EQ(trail.size(), CommandTrail::kMost);
  EXPECT_EQ(trail[0].low.velocity[0], 0.0);
  EXPECT_NEAR(trail[0].high.velocity[0], 0.152, 1e-9);
  trail.note(300 * kMs, forward(0.199));
  EXPECT_EQ(trail[CommandTrail::kMost - 1].from_ns, 199 * kMs) << "the same is not noted twice";
  trail.forget(250 * kMs);
  EXPECT_EQ(trail.size(), 1U);
}

}  // namespace
}  // namespace tandem::mixed_reality
