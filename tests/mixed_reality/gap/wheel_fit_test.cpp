// Parameters of wheels are found again from poses and commands; what the data does not tell is said to be so.
#include "mixed_reality/gap/wheel_fit.hpp"

#include <algorithm>
#include <gtest/gtest.h>
#include <string>

#include "mixed_reality/gap/population.hpp"
#include "tests/mixed_reality/gap/driven.hpp"
#include "tests/mixed_reality/gap/hidden_robot.hpp"

namespace tandem::mixed_reality {
namespace {

WheelFit fit_of(const Driven& driven, bool by_wheels = false) {
  return fit_wheels(driven.record(), driven.tick_s, {driven.wheel_base_m, by_wheels});
}

void expect_found(const Estimate& found, double truth, double within) {
  EXPECT_TRUE(found.observable);
  EXPECT_NEAR(found.value, truth, within);
  EXPECT_LT(std::fabs(found.value - truth), 4.0 * found.error);
  EXPECT_LT(found.error, within);
}

TEST(WheelFit, FindsScalesBaseNoiseAndDelayWithinTheirErrors) {
  Driven driven;
  driven.model = {0.97, 1.02, 1.04, 1.0, 0.98, 0.004, 0.137};
  driven.mount_rad = 0.05;
  const WheelFit fit = fit_of(driven);
  ASSERT_EQ(fit.flaw, "");
  expect_found(fit.left, 0.97, 0.01);
  expect_found(fit.right, 1.02, 0.01);
  expect_found(fit.base, 1.04, 0.01);
  expect_found(fit.delay_s, 0.137, 0.004);
  expect_found(fit.mount_rad, 0.05, 0.01);
  EXPECT_NEAR(fit.noise_sqrt_m.value, 0.004, 0.0015);
  EXPECT_NEAR(fit.place_noise_m.value, 0.002, 2e-4);
  expect_found(fit.counted_right, 0.98, 0.01);
  expect_found(fit.slip_left, 0.03, 0.01);
}

TEST(WheelFit, IsNotLedAstrayByBacklashUnevenGroundAndBeingCarried) {
  Driven driven;
  driven.seconds = 240.0;
  driven.model = {1.03, 0.99, 0.96, 1.0, 1.0, 0.002, 0.061};
  driven.backlash_m = 0.0003;
  driven.bumps = 0.03;
  RecordedRobot robot = driven.record();
  for (std::size_t t = 700; t < robot.ticks.size(); ++t) robot.ticks[t].x_m += 0.3;  // carried
  const WheelFit fit = fit_wheels(robot, driven.tick_s, {driven.wheel_base_m, false});
  EXPECT_NEAR(fit.left.value, 1.03, 0.01);
  EXPECT_NEAR(fit.right.value, 0.99, 0.01);
  EXPECT_NEAR(fit.base.value, 0.96, 0.01);
  EXPECT_NEAR(fit.delay_s.value, 0.061, 0.002);
  EXPECT_NEAR(fit.play_m.value, 0.0003, 0.0001);
  EXPECT_GE(fit.left_out, 1U);
}

TEST(WheelFit, TellsNoDelayByTrackersWhoseStampsAreEstimates) {
  HiddenRobot robot;
  robot.seconds = 60.0;
  robot.command = 0.06;
  robot.tracker_late = 0.04;
  WheelSeries series = robot.drive();
  series.stamps_are_right = false;
  const WheelFit fit = fit_wheels(series, {.wheel_base_m = robot.base_m});
  EXPECT_FALSE(fit.delay_s.observable);
  EXPECT_FALSE(fit.lag_s.observable);
  EXPECT_TRUE(fit.counter_delay_s.observable);
  EXPECT_NEAR(fit.counter_delay_s.value, 0.06, 0.002);
  EXPECT_NEAR(fit.left.value, 1.0, 0.01);
  EXPECT_FALSE(fit.parts.body.told);
}

TEST(WheelFit, SaysWhatTheDataDoesNotTell) {
  Driven driven;
  driven.seconds = 30.0;
  RecordedRobot straight = driven.record();
  double x = 0.0;
  for (RobotTick& tick : straight.ticks) {
    tick.told_left_m_s = tick.told_right_m_s = 0.08;
    tick.x_m = x;
    tick.y_m = tick.heading_rad = 0.0;
    x += 0.008;
  }
  const WheelFit fit = fit_wheels(straight, driven.tick_s, {driven.wheel_base_m, false});
  EXPECT_FALSE(fit.base.observable) << fit.base.value << " +- " << fit.base.error;
  EXPECT_TRUE(fit.left.observable);
  const WheelFit by_wheels = fit_of(driven, true);
  EXPECT_FALSE(by_wheels.left.observable);
  EXPECT_FALSE(by_wheels.slip_left.observable);

  RecordedRobot silent = driven.record();
  for (RobotTick& tick : silent.ticks) tick.told = false;
  EXPECT_NE(fit_wheels(silent, driven.tick_s, {driven.wheel_base_m, false}).flaw, "");
}

TEST(Population, TakesTheErrorsOfEstimatesAwayFromTheirSpread) {
  std::vector<hal::FittedRobot<hal::WheelModel>> robots(4);
  for (std::size_t i = 0; i < robots.size(); ++i) {
    robots[i].value.of.left = 1.0 + 0.01 * static_cast<double>(i);  // variance 1.667e-4
    robots[i].error.of.left = 0.01;
    robots[i].value.of.right = 1.0 + 0.001 * static_cast<double>(i);
    robots[i].error.of.right = 0.01;
  }
  const auto part = population<hal::FittedWheels>(robots);
  EXPECT_NEAR(part.mean.of.left, 1.015, 1e-12);
  EXPECT_NEAR(part.spread.of.left, std::sqrt(1.6667e-4 - 1e-4), 1e-5);
  EXPECT_EQ(part.spread.of.right, 0.0);
}

}  // namespace
}  // namespace tandem::mixed_reality
