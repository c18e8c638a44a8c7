// Parameters of wheels are found again from poses and commands; what the data does not tell is said to be so.
#include "mixed_reality/gap/wheel_fit.hpp"

#include <algorithm>
#include <gtest/gtest.h>
#include <map>
#include <numeric>
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

/// Delays of the link, the motors, the body and the counters, as somebody hid them.
struct Hidden {
  const char* what;
  double link_in, link_out, command, body, counters;
};

TEST(WheelFit, TellsDelaysOfAnyRobotFromStampsAndPlaces) {
  for (const Hidden& h :
       {Hidden{"encoders lag as the body does", 0.0, 0.0, 0.06, 0.0, 0.0},
        Hidden{"only the body lags", 0.0, 0.0, 0.0, 0.06, 0.0}, Hidden{"all of it, much", 0.0, 0.0, 0.11, 0.0, 0.0},
        Hidden{"the link alone", 0.03, 0.03, 0.0, 0.0, 0.0}, Hidden{"a third each", 0.02, 0.02, 0.02, 0.0, 0.02},
        Hidden{"counters alone", 0.0, 0.0, 0.0, 0.0, 0.06}}) {
    HiddenRobot robot;
    robot.seconds = 120.0;
    robot.left = 1.02;
    robot.base = 0.97;
    robot.link_in = h.link_in;
    robot.link_out = h.link_out;
    robot.command = h.command;
    robot.body = h.body;
    robot.counters = h.counters;
    WheelFitOptions options;
    options.wheel_base_m = robot.base_m;
    options.round_trip_s = h.link_in + h.link_out;
    const WheelFit fit = fit_wheels(robot.drive(), options);
    ASSERT_EQ(fit.flaw, "") << h.what;
    const auto expect_told = [&](const Estimate& found, double truth) {
      EXPECT_TRUE(found.observable) << h.what;
      EXPECT_NEAR(found.value, truth, 0.003) << h.what;
      EXPECT_LE(std::fabs(found.value - truth), 1.6 * found.bound() + 1e-4) << h.what;
      EXPECT_LT(found.bound(), 0.003) << h.what;
    };
    const double to_way = h.link_in + h.command + h.body;
    const double to_counters = 0.5 * (h.link_in + h.link_out) + h.command + h.counters;
    expect_told(fit.delay_s, to_way);
    expect_told(fit.counter_delay_s, to_counters);
    expect_told(fit.lag_s, to_way - to_counters);
    // Parts are told, or not; what is told holds.
    for (const auto& [part, truth] : {std::pair{fit.parts.link_in, h.link_in}, std::pair{fit.parts.command, h.command},
                                      std::pair{fit.parts.body, h.body}, std::pair{fit.parts.counters, h.counters}}) {
      if (!part.told) continue;
      EXPECT_LE(std::fabs(part.value_s - truth), part.bound_s + 2e-3) << h.what;
    }
    const bool body_is_left = h.command + h.counters + h.link_in == 0.0;  // nothing else can be the late one
    EXPECT_EQ(fit.parts.body.told, body_is_left || to_way == 0.0) << h.what;
    EXPECT_EQ(fit.parts.command.told, to_counters - 0.5 * (h.link_in + h.link_out) == 0.0) << h.what;
    EXPECT_EQ(fit.parts.link_in.told, h.link_in == 0.0) << h.what;
  }
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

TEST(WheelFit, FindsTheNoiseOfWheelsAndTrackers) {
  for (const double noise : {0.002, 0.002, 0.005}) {
    HiddenRobot robot;
    robot.seconds = 200.0;
    robot.wheel_noise = noise;
    robot.body = 0.06;
    robot.seed = noise > 0.004 ? 5 : 4;
    const WheelFit fit = fit_wheels(robot.drive(), {.wheel_base_m = robot.base_m});
    EXPECT_NEAR(fit.noise_sqrt_m.value, noise, 0.15 * noise);
    EXPECT_NEAR(fit.place_noise_m.value, robot.place_noise, 0.05 * robot.place_noise);
    EXPECT_NEAR(fit.place_noise_rad.value, robot.heading_noise, 0.05 * robot.heading_noise);
  }
}

/// 95 of 100 bounds hold, of every value, for robots that were drawn; the interval is the binomial's of one in 10,000.
TEST(WheelFit, BoundsHoldAsOftenAsTheySay) {
  constexpr int kRobots = 60;
  std::map<std::string, std::vector<double>> held;
  std::map<std::string, std::vector<double>> half;
  for (int i = 0; i < kRobots; ++i) {
    std::mt19937_64 dice(static_cast<unsigned>(4000 + i));
    std::uniform_real_distribution<double> even;
    const auto about_1 = [&] { return 0.95 + 0.1 * even(dice); };
    const auto delay = [&] { return std::max(0.0, 0.1 * even(dice) - 0.03); };
    HiddenRobot robot;
    robot.seed = static_cast<unsigned>(i);
    robot.seconds = 100.0;
    robot.places_hz = 15.0;
    robot.sees_heading = i % 3 != 0;
    robot.left = about_1();
    robot.right = about_1();
    robot.base = about_1();
    robot.wheel_noise = 0.001 + 0.004 * even(dice);
    robot.place_noise = 0.001 + 0.003 * even(dice);
    robot.link_in = delay();
    robot.link_out = delay();
    robot.command = delay();
    robot.body = delay();
    robot.counters = delay();
    const WheelFit fit = fit_wheels(robot.drive(), {.wheel_base_m = robot.base_m});
    ASSERT_EQ(fit.flaw, "");
    const double to_way = robot.link_in + robot.command + robot.body;
    const double to_counters = 0.5 * (robot.link_in + robot.link_out) + robot.command + robot.counters;
    const auto note = [&](const char* name, const Estimate& found, double truth) {
      if (!found.observable) return;
      held[name].push_back(truth >= found.low() && truth <= found.high() ? 1.0 : 0.0);
      half[name].push_back(found.bound());
    };
    note("left", fit.left, robot.left);
    note("right", fit.right, robot.right);
    note("base", fit.base, robot.base);
    note("delay", fit.delay_s, to_way);
    note("counters", fit.counter_delay_s, to_counters);
    note("lag", fit.lag_s, to_way - to_counters);
    note("noise", fit.noise_sqrt_m, robot.wheel_noise);
    note("places", fit.place_noise_m, robot.place_noise);
  }
  for (const auto& [name, all] : held) {
    ASSERT_EQ(all.size(), static_cast<std::size_t>(kRobots)) << name;
    const double share = std::accumulate(all.begin(), all.end(), 0.0) / kRobots;
    EXPECT_GE(share, 0.82) << name;  // 49 of 60: below it lies 1 in 10,000 of the binomial of 0.95
    std::vector<double>& bounds = half[name];
    std::nth_element(bounds.begin(), bounds.begin() + kRobots / 2, bounds.end());
    const double most = name == "left" || name == "right" ? 0.006 : name == "base" ? 0.006 : 0.003;
    EXPECT_LT(bounds[kRobots / 2], most) << name;
  }
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
