// Delays, noise and bounds of wheels that were hidden, over many robots: sums that take their time.
#include <algorithm>
#include <gtest/gtest.h>
#include <map>
#include <numeric>
#include <random>
#include <string>

#include "mixed_reality/gap/wheel_fit.hpp"
#include "tests/mixed_reality/gap/hidden_robot.hpp"

namespace tandem::mixed_reality {
namespace {

/// Delays of the link, the motors, the body and the counters, as somebody hid them.
struct Hidden {
  const char* what;
  double link_in, link_out, command, body, counters;
};

TEST(WheelFitOfMany, TellsDelaysOfAnyRobotFromStampsAndPlaces) {
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

TEST(WheelFitOfMany, FindsTheNoiseOfWheelsAndTrackers) {
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

/// Commands that act unevenly move a robot as wheels do that slip by chance, and are not to pass for it: where the
/// wheels have no noise, the interval holds 0. 8 of 12: below it lie 2 in 10,000 of the binomial of 0.95.
TEST(WheelFitOfMany, TellsNoNoiseOfWheelsThatHaveNone) {
  constexpr int kRobots = 12;
  int held = 0;
  for (int i = 0; i < kRobots; ++i) {
    HiddenRobot robot;
    robot.seed = static_cast<unsigned>(i);
    robot.seconds = 60.0;
    robot.wheel_noise = 0.0;
    robot.command_jitter = i % 2 == 0 ? 0.0 : 0.002;
    robot.right_later = i % 4 < 2 ? 0.0 : 0.001;
    const Estimate noise = fit_wheels(robot.drive(), {.wheel_base_m = robot.base_m}).noise_sqrt_m;
    EXPECT_TRUE(noise.observable) << i;
    EXPECT_LT(noise.high(), 0.001) << i;
    held += noise.low() == 0.0 ? 1 : 0;
  }
  EXPECT_GE(held, 8);
}

TEST(WheelFitOfMany, FindsTheNoiseOfWheelsBesideCommandsThatActUnevenly) {
  HiddenRobot robot;
  robot.seconds = 120.0;
  robot.wheel_noise = 0.002;
  robot.command_jitter = 0.004;
  const Estimate noise = fit_wheels(robot.drive(), {.wheel_base_m = robot.base_m}).noise_sqrt_m;
  EXPECT_NEAR(noise.value, 0.002, 0.0003);
  EXPECT_GT(noise.low(), 0.001);
}

/// 95 of 100 bounds hold, of every value, for robots that were drawn; the interval is the binomial's of one in 10,000.
TEST(WheelFitOfMany, BoundsHoldAsOftenAsTheySay) {
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

}  // namespace
}  // namespace tandem::mixed_reality
