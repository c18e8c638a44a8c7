// The curve, noise and age of proximity readings are found again from distances that are known.
#include "mixed_reality/gap/proximity_fit.hpp"

#include <gtest/gtest.h>
#include <random>

namespace tandem::mixed_reality {
namespace {

constexpr double kTick_s = 0.1;

/// A robot that goes to and fro before a wall.
ProximitySeries before_a_wall(const hal::ProximityModel& model, std::size_t ticks = 900) {
  std::mt19937 random(3);
  std::normal_distribution<double> normal;
  const double range_m = 0.1;
  ProximitySeries series{2, range_m, {}, {}};
  const auto wall_m = [](double t, std::size_t ray) {
    return 0.045 + 0.02 * static_cast<double>(ray) + 0.03 * std::sin(1.7 * t) + 0.02 * std::sin(0.61 * t);
  };
  for (std::size_t i = 0; i < ticks; ++i) {
    const double t = static_cast<double>(i) * kTick_s;
    for (std::size_t k = 0; k < 2; ++k) {
      series.distance_m.push_back(std::min(wall_m(t, k), range_m));
      const double seen = wall_m(t - model.delay_s, k);
      double read = range_m;
      if (seen < range_m)
        read = range_m * model.gain * std::pow(std::max(0.0, seen) / range_m, model.exponent) + model.offset_m;
      series.read_m.push_back(static_cast<float>(std::clamp(read + model.noise_m * normal(random), 0.0, range_m)));
    }
  }
  return series;
}

TEST(ProximityFit, FindsCurveNoiseAndDelay) {
  const hal::ProximityModel truth{0.9, 1.3, 0.004, 0.0015, 0.13};
  const ProximityFit fit = fit_proximity(before_a_wall(truth), kTick_s);
  ASSERT_EQ(fit.flaw, "");
  EXPECT_TRUE(fit.gain.observable && fit.exponent.observable && fit.offset_m.observable && fit.delay_s.observable);
  EXPECT_NEAR(fit.gain.value, truth.gain, 0.03);
  EXPECT_NEAR(fit.exponent.value, truth.exponent, 0.08);
  EXPECT_NEAR(fit.offset_m.value, truth.offset_m, 0.0015);
  EXPECT_NEAR(fit.noise_m.value, truth.noise_m, 0.0002);
  EXPECT_NEAR(fit.delay_s.value, truth.delay_s, 0.005);
  // What is wanted of it is the curve.
  for (const double x : {0.2, 0.5, 0.8}) {
    const double found = 0.1 * fit.gain.value * std::pow(x, fit.exponent.value) + fit.offset_m.value;
    EXPECT_NEAR(found, 0.1 * truth.gain * std::pow(x, truth.exponent) + truth.offset_m, 3e-4);
  }
}

TEST(ProximityFit, SaysWhenNothingWasNear) {
  ProximitySeries series = before_a_wall({}, 300);
  for (float& read : series.read_m) read = 0.1F;
  EXPECT_NE(fit_proximity(series, kTick_s).flaw, "");
  EXPECT_NE(fit_proximity({}, kTick_s).flaw, "");
}

TEST(Surroundings, AreWallsCylindersAndTheOtherRobots) {
  RecordedRun run;
  run.scene = hal::parse_json(R"({"objects": [
    {"x": 1.0, "y": 0.0, "heading": 0.0, "size_x": 1.0, "size_y": 4.0, "movable": false},
    {"x": 0.0, "y": -0.3, "radius": 0.1, "movable": false},
    {"x": 0.0, "y": 0.2, "radius": 0.1, "movable": true}]})")
                  .value();
  run.ticks = 1;
  run.robots.resize(2);
  for (RecordedRobot& robot : run.robots) robot.ticks.resize(1);
  run.robots[0].ticks[0] = {true, false, false, false, false, 0.42, 0.0, 0.0};
  run.robots[1].ticks[0] = {true, false, false, false, false, 0.42, 0.12, 0.0};
  const Surroundings surroundings(run, {0.035, 0.035});
  const std::vector<hal::Mount> mounts = {{0.0, 0.035, 0.0, 0.03}, {1.5707963267948966, 0.0, 0.035, 0.03}};
  const auto seen = surroundings.distances(0, 0, mounts, 0.1);
  EXPECT_NEAR(seen[0], 0.5 - 0.42 - 0.035, 1e-6);
  EXPECT_NEAR(seen[1], 0.12 - 0.07, 1e-6);
  EXPECT_NEAR(surroundings.distances(1, 0, mounts, 0.1)[1], 0.1, 1e-6);
}

}  // namespace
}  // namespace tandem::mixed_reality
