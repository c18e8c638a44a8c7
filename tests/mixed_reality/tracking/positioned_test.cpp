#include "mixed_reality/tracking/positioned.hpp"

#include <cmath>
#include <gtest/gtest.h>
#include <limits>

namespace tandem::mixed_reality {
namespace {

constexpr hal::TimeNs kS = hal::kNsPerSecond;

TEST(PositionedRobot, IsWhereItSaysWhenItSaysSo) {
  hal::Positioning places;
  Positioned source(core::Pose::at(1.0, 1.0, 0.0), places);
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
  Positioned source({}, places);
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
  Positioned source(core::Pose::at(1.0, 0.0, 0.0), places);
  const TrackedPose tracked = source.latch({kS, 101 * kS});
  EXPECT_FALSE(tracked.known);
  EXPECT_EQ(tracked.pose.x_m, 1.0);
  EXPECT_EQ(source.rejected(), 1U);
}

}  // namespace
}  // namespace tandem::mixed_reality
