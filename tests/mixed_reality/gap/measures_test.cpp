// Measures of the gap against closed forms.
#include "mixed_reality/gap/measures.hpp"

#include <cmath>
#include <gtest/gtest.h>

namespace tandem::mixed_reality {
namespace {

/// Robots that go along a curve, turned and moved as a whole, and faster by `scale`.
RecordedRun curve(double turn_rad, double x_m, double scale, double heading_off = 0.0) {
  RecordedRun run;
  run.ticks = 101;
  run.scene = hal::parse_json(R"({"arena": {"min_x": -4, "min_y": -4, "max_x": 4, "max_y": 4}})").value();
  for (int k = 0; k < 2; ++k) {
    RecordedRobot& robot = run.robots.emplace_back();
    robot.id = "r" + std::to_string(k);
    for (std::size_t i = 0; i < run.ticks; ++i) {
      const double s = 0.01 * static_cast<double>(i) * scale, y = 0.2 * s * s + k;
      RobotTick tick;
      tick.posed = true;
      tick.x_m = std::cos(turn_rad) * s - std::sin(turn_rad) * y + x_m;
      tick.y_m = std::sin(turn_rad) * s + std::cos(turn_rad) * y;
      tick.heading_rad = turn_rad + heading_off;
      robot.ticks.push_back(tick);
    }
  }
  return run;
}

TEST(Gap, ATrajectoryThatIsOnlyTurnedAndMovedFitsWhenItIsLaidOver) {
  const Gap gap = gap_between(curve(0, 0, 1), curve(0.3, 0.5, 1), {});
  ASSERT_EQ(gap.robots.size(), 2U);
  EXPECT_NEAR(gap.robots[0].absolute_m, 0.0, 1e-9);
  EXPECT_GT(gap.robots[0].apart_m, 0.4);
  EXPECT_NEAR(gap.robots[0].heading_rad, 0.3, 1e-9);
  EXPECT_NEAR(gap.robots[0].relative_m, 0.0, 1e-9);
  EXPECT_NEAR(gap.distributions[0].moved, 0.0, 1e-9);  // speed
}

TEST(Gap, TellsWhatIsFasterByItsEndItsSpeedAndItsPlaces) {
  const RecordedRun a = curve(0, 0, 1), b = curve(0, 0, 1.5);
  const Gap gap = gap_between(a, b, {"r1"});
  ASSERT_EQ(gap.robots.size(), 1U);
  const double end = std::hypot(0.5, 0.2 * (2.25 - 1.0));
  EXPECT_NEAR(gap.robots[0].end_m_per_m, end / gap.robots[0].way_m, 1e-9);
  EXPECT_GT(gap.robots[0].relative_m, 0.04);
  EXPECT_GT(gap.distributions[0].largest, 0.9);
  EXPECT_GT(gap.occupancy, 0.02);
  EXPECT_EQ(gap_between(a, a, {}).occupancy, 0.0);
  EXPECT_EQ(to_json(gap)["robots"][0]["robot"], "r1");
}

TEST(Gap, DistancesOfDistributionsAreThoseOfTheirDefinitions) {
  EXPECT_EQ(kolmogorov_smirnov({1, 2, 3}, {3, 1, 2}), 0.0);
  EXPECT_EQ(kolmogorov_smirnov({1, 2}, {3, 4}), 1.0);
  EXPECT_NEAR(kolmogorov_smirnov({1, 2, 3, 4}, {3, 4, 5, 6}), 0.5, 1e-12);
  EXPECT_NEAR(wasserstein({0, 1, 2}, {5, 6, 7}), 5.0, 1e-12);
  EXPECT_NEAR(wasserstein({0, 0}, {0, 1, 2}), 1.0, 1e-12);
}

}  // namespace
}  // namespace tandem::mixed_reality
