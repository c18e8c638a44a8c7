// Delays of the emulated e-puck, each by itself, against a clock that the test turns.
#include <cstdio>

#include "bridges/epuck_emulator/body.hpp"
#include "tests/bridges/epuck_emulator/bench.hpp"

namespace tandem::bridges::epuck_emulator {
namespace {

constexpr TimeNs kMs = hal::kNsPerMs;

/// When the body was first driven after the robot had its command, looked at every millisecond.
double driven_after_s(const Delays& delays) {
  Firmware::Options options;
  options.delays = delays;
  Bench bench(options);
  bench.send("D,500,500\r");
  const TimeNs told = bench.now;
  while (bench.body.command().left_m_s == 0.0 && bench.now < told + kSecond) bench.wait(kMs);
  return hal::to_seconds(bench.now - told);
}

/// What the counters say a second after the command.
int counted_after_a_second(const Delays& delays) {
  Firmware::Options options;
  options.delays = delays;
  Bench bench(options);
  bench.send("D,500,500\r");
  bench.wait(kSecond);
  bench.send("Q\r");
  int left = 0, right = 0;
  const std::string answer = bench.listen();
  std::sscanf(answer.c_str() + answer.find("q,"), "q,%d,%d", &left, &right);
  EXPECT_EQ(left, right);
  return left;
}

TEST(EpuckDelays, CommandsReachTheMotorsLateAndTheBodyLaterStill) {
  EXPECT_NEAR(driven_after_s({}), 0.0, 0.0011);
  EXPECT_NEAR(driven_after_s({.command_s = 0.04}), 0.04, 0.0011);
  EXPECT_NEAR(driven_after_s({.command_s = 0.04, .body_s = 0.03}), 0.07, 0.0011);
  EXPECT_NEAR(driven_after_s({.counters_s = 0.05}), 0.0, 0.0011);
}

TEST(EpuckDelays, CountersLagTheMotorsAndNotTheBody) {
  const int at_once = counted_after_a_second({});
  EXPECT_NEAR(at_once, 500, 3);
  EXPECT_NEAR(counted_after_a_second({.command_s = 0.04}), at_once - 20, 1);
  EXPECT_NEAR(counted_after_a_second({.counters_s = 0.06}), at_once - 30, 1);
  EXPECT_NEAR(counted_after_a_second({.command_s = 0.04, .counters_s = 0.06}), at_once - 50, 1);
  EXPECT_NEAR(counted_after_a_second({.body_s = 0.1}), at_once, 1);
}

TEST(EpuckDelays, AResetStopsTheMotorsAtOnce) {
  Firmware::Options options;
  options.delays = {.command_s = 0.2};
  Bench bench(options);
  bench.send("D,500,500\r");
  bench.wait(kSecond);
  EXPECT_GT(bench.body.command().left_m_s, 0.0);
  bench.firmware.reset(bench.now, "button");
  EXPECT_EQ(bench.body.command().left_m_s, 0.0);
}

TEST(EpuckDelays, TheGyroscopeTellsOfTheBody) {
  const double base_m = robot_part<hal::DifferentialDrive>().wheel_base_m;
  KinematicBody body({}, {}, {.left = 0.9, .right = 1.1, .base = 1.05, .delay_s = 0.05});
  body.actuate(0, {.left_m_s = 0.05, .right_m_s = 0.1});
  EXPECT_EQ(body.sense(40 * kMs).turn_rad_s[2], 0.0);
  const double turn_rad_s = body.sense(60 * kMs).turn_rad_s[2];
  EXPECT_NEAR(turn_rad_s, (1.1 * 0.1 - 0.9 * 0.05) / (1.05 * base_m), 1e-12);
  const double before_rad = body.pose().heading_rad;
  body.advance(160 * kMs);
  EXPECT_NEAR(body.pose().heading_rad - before_rad, 0.1 * turn_rad_s, 1e-9);
}

}  // namespace
}  // namespace tandem::bridges::epuck_emulator
