#include "bridges/emulation/true_pose.hpp"

#include <gtest/gtest.h>
#include <numbers>

namespace tandem::bridges {
namespace {

TEST(TruePose, RollsInACircleAndStraightAhead) {
  BodyPose pose{1.0, 0.0, std::numbers::pi / 2};
  const double base_m = 0.1, radius_m = 1.0, quarter_rad = std::numbers::pi / 2;
  for (int i = 0; i < 10; ++i)
    pose = rolled(pose, (radius_m - base_m / 2) * quarter_rad / 10, (radius_m + base_m / 2) * quarter_rad / 10, base_m);
  EXPECT_NEAR(pose.x_m, 0.0, 1e-12);
  EXPECT_NEAR(pose.y_m, 1.0, 1e-12);
  EXPECT_NEAR(std::fabs(pose.heading_rad), std::numbers::pi, 1e-12);
  pose = rolled(pose, 0.5, 0.5, base_m);
  EXPECT_NEAR(pose.x_m, -0.5, 1e-12);
}

TEST(TruePose, IsToldAsOftenAsAskedAndOnlyWhenItIsNew) {
  PoseTeller teller(10.0);
  std::optional<BodyPose> pose;
  std::vector<hal::TimeNs> told;
  const auto turn = [&](hal::TimeNs now) {
    teller.turn(
        now, [&](hal::TimeNs) { return pose; },
        [&](hal::TimeNs, std::string_view event, const EventFields& fields) {
          EXPECT_EQ(event, "pose");
          told.push_back(std::get<std::int64_t>(fields[3].value));
        });
  };
  turn(0);  // nobody knows it yet
  pose = BodyPose{0.0, 0.0, 0.0, 70};
  for (hal::TimeNs now = 0; now <= 300 * hal::kNsPerMs; now += 10 * hal::kNsPerMs) turn(now);
  EXPECT_EQ(told, (std::vector<hal::TimeNs>{70})) << "the arena stands";
  pose->taken_ns = 80;
  for (hal::TimeNs now = 300 * hal::kNsPerMs; now <= 380 * hal::kNsPerMs; now += 10 * hal::kNsPerMs) turn(now);
  EXPECT_LE(told.size(), 2U);
  EXPECT_EQ(PoseTeller(0.0).due(), kEndless);
}

}  // namespace
}  // namespace tandem::bridges
