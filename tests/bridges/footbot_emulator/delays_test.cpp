// Delays of the emulated foot-bot, each by itself, against a clock that the test turns.
#include "tests/bridges/footbot_emulator/bench.hpp"

namespace tandem::bridges::footbot_emulator {
namespace {

const char* const kLeftFull = "300#0CA0010022004800";  // 72 raw

Footbot::Options with(const Delays& delays) {
  Footbot::Options options;
  options.delays = delays;
  return options;
}

/// When the body's wheel turned first, looked at every millisecond.
double driven_after_s(const Delays& delays) {
  Bench bench(with(delays));
  const hal::TimeNs told = bench.now;
  bench.say(kLeftFull);
  while (bench.body.command().left_m_s == 0.0 && bench.now < told + 1000 * kMs) bench.pass(kMs);
  return hal::to_seconds(bench.now - told);
}

/// Pulses that the left motor's encoder tells so long after the command.
int pulses_after(const Delays& delays, hal::TimeNs time) {
  Bench bench(with(delays));
  bench.say(kLeftFull);
  bench.pass(time);
  const auto odo = bench.read(1, 35, 2);
  return (odo[1] << 16) + (odo[0] & 0xFFFF);
}

TEST(FootbotDelays, CommandsReachTheMotorsLateAndTheBodyLaterStill) {
  EXPECT_NEAR(driven_after_s({}), 0.0, 0.0011);
  EXPECT_NEAR(driven_after_s({.command_s = 0.037}), 0.037, 0.0011);
  EXPECT_NEAR(driven_after_s({.command_s = 0.037, .body_s = 0.021}), 0.058, 0.0011);
  EXPECT_NEAR(driven_after_s({.counters_s = 0.05}), 0.0, 0.0011);
}

TEST(FootbotDelays, EncodersLagByTheirOwn) {
  const hal::TimeNs second = 1000 * kMs;
  const int at_once = pulses_after({}, second);
  ASSERT_GT(at_once, 1000);
  const auto lag = [&](const Delays& delays) {
    return static_cast<double>(at_once - pulses_after(delays, second)) / at_once;
  };
  EXPECT_NEAR(lag({.command_s = 0.04}), 0.04, 0.001);
  EXPECT_NEAR(lag({.counters_s = 0.06}), 0.06, 0.001);
  EXPECT_NEAR(lag({.command_s = 0.04, .counters_s = 0.06}), 0.1, 0.001);
  EXPECT_NEAR(lag({.body_s = 0.1}), 0.0, 0.001);
}

}  // namespace
}  // namespace tandem::bridges::footbot_emulator
