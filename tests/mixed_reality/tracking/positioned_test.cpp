#include "mixed_reality/tracking/positioned.hpp"

#include <cmath>
#include <gtest/gtest.h>
#include <limits>

#include "hal/robot/eyebot.hpp"

namespace tandem::mixed_reality {
namespace {

constexpr hal::TimeNs kS = hal::kNsPerSecond;

TEST(PositionedRobot, IsWhereItSaysWhenItSaysSo) {
  hal::Positioning places;
  Positioned source(core::Pose::at(1.0, 1.0, 0.0), places, hal::eyebot::kind());
  TrackedPose tracked = source.latch({5 * kS, 105 * kS});
  EXPECT_FALSE(tracked.known);
  EXPECT_EQ(tracked.pose.x_m, 1.0);

  places.validity = hal::Validity::Fresh;
  places.taken_ns = 4 * kS;  // on the run's clock
  places.p_WB = {2.0, -1.0, 1.5};
  const double half_rad = 0.5 * 0.75;
  places.q_WB = {std::cos(half_rad), 0.0, 0.0, std::sin(half_rad)};
  tracked = source.latch({5 * kS, 105 * kS});
  EXPECT_TRUE(tracked.known);
  EXPECT_EQ(tracked.taken_ns, 104 * kS);
  EXPECT_EQ(tracked.pose.x_m, 2.0);
  EXPECT_EQ(tracked.pose.y_m, -1.0);
  EXPECT_EQ(tracked.pose.z_m, 1.5);
  EXPECT_NEAR(tracked.pose.heading_rad(), 0.75, 1e-12);
}

TEST(PositionedRobot, StaysWhereItWasWhenItSaysNothingNew) {
  hal::Positioning places;
  places.validity = hal::Validity::Fresh;
  places.taken_ns = kS;
  places.p_WB = {2.0, 0.0, 0.0};
  Positioned source({}, places, hal::eyebot::kind());
  (void)source.latch({kS, 101 * kS});
  places.validity = hal::Validity::Stale;
  const TrackedPose tracked = source.latch({3 * kS, 103 * kS});
  EXPECT_TRUE(tracked.known);
  EXPECT_EQ(tracked.taken_ns, 101 * kS);
}

TEST(PositionedRobot, IsNotBelievedWhenItIsNowhere) {
  hal::Positioning places;
  places.validity = hal::Validity::Fresh;
  places.p_WB = {std::numeric_limits<double>::quiet_NaN(), 0.0, 0.0};
  Positioned source(core::Pose::at(1.0, 0.0, 0.0), places, hal::eyebot::kind());
  const TrackedPose tracked = source.latch({kS, 101 * kS});
  EXPECT_FALSE(tracked.known);
  EXPECT_EQ(tracked.pose.x_m, 1.0);
  EXPECT_EQ(source.rejected(), 1U);
}

/// Says in every tick where it is.
class Said : public testing::Test {
 protected:
  TrackedPose says(double x_m, hal::TimeNs ahead_ns = 0) {
    now_ns_ += kS / 10;
    places_.validity = hal::Validity::Fresh;
    places_.taken_ns = now_ns_ + ahead_ns;
    places_.p_WB = {x_m, 0.0, 1.0};
    return source_.latch({now_ns_, now_ns_ + 100 * kS});
  }
  hal::Positioning places_;
  Positioned source_{{}, places_, hal::eyebot::kind()};
  hal::TimeNs now_ns_ = 0;
};

TEST_F(Said, APlaceOfTheFutureIsNotBelieved) {
  (void)says(1.0);
  EXPECT_EQ(says(1.1, 3 * kS).pose.x_m, 1.0);
  EXPECT_EQ(source_.rejected(), 1U);
  EXPECT_EQ(says(1.1).pose.x_m, 1.1);
}

TEST_F(Said, APlaceThatItCannotHaveReachedIsNotBelieved) {
  (void)says(1.0);
  const TrackedPose tracked = says(4.0);
  EXPECT_EQ(tracked.pose.x_m, 1.0);
  EXPECT_EQ(tracked.taken_ns, 100 * kS + kS / 10);  // and grows old
  EXPECT_EQ(source_.rejected(), 1U);
  EXPECT_EQ(says(1.05).pose.x_m, 1.05);
  EXPECT_EQ(source_.jumps(), 0U);
}

TEST_F(Said, WhatItInsistsOnIsBelievedInTheEndAndIsAJump) {
  (void)says(1.0);
  for (int i = 1; i < Positioned::kInsists; ++i) EXPECT_EQ(says(4.0 + 0.01 * i).pose.x_m, 1.0) << i;
  EXPECT_EQ(says(4.0).pose.x_m, 4.0);
  EXPECT_EQ(source_.jumps(), 1U);
}

TEST_F(Said, NoiseAllOverThePlaceIsNeverBelieved) {
  (void)says(1.0);
  for (int i = 0; i < 12; ++i) EXPECT_EQ(says(i % 2 == 0 ? 8.0 : -8.0).pose.x_m, 1.0) << i;
  EXPECT_EQ(source_.rejected(), 12U);
}

}  // namespace
}  // namespace tandem::mixed_reality
