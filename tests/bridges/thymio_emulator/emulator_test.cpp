// The emulated Thymio: its numbers, its faults, and what it refuses.
#include "bridges/thymio_emulator/emulator.hpp"

#include <gmock/gmock.h>

#include "bridges/thymio_emulator/faults.hpp"
#include "bridges/thymio_emulator/raw_units.hpp"

namespace tandem::bridges::thymio_emulator {
namespace {

using testing::HasSubstr;

TEST(EmulatedThymio, SaysWhatItsSensorsWould) {
  EXPECT_EQ(proximity_raw(0.0), 4505);
  EXPECT_EQ(proximity_raw(0.05), 3366);
  EXPECT_EQ(proximity_raw(0.139), 1239);
  EXPECT_EQ(proximity_raw(0.14), 0);
  EXPECT_EQ(ground_raw(1.0), 820);
  EXPECT_EQ(ground_raw(0.0), 10);
  EXPECT_EQ(acceleration_raw(9.81), 23);
  EXPECT_EQ(acceleration_raw(-100.0), -32);
  EXPECT_DOUBLE_EQ(wheel_m_s(500), 0.2);
  EXPECT_DOUBLE_EQ(wheel_m_s(-3000), -0.2);
}

TEST(EmulatedThymio, KeepsItsTargetsForEverWithoutAProgram) {
  KinematicBody body;
  Thymio robot({}, body, {});
  robot.power_on(0);
  EXPECT_FALSE(robot.first_driven_at());
  Message set{0, aseba_emulation::type::kSetVariables, {}};
  robot.receive(set.add(1).add(57).add(100), 0);
  EXPECT_EQ(robot.left_target(), 100);
  robot.run_until(60 * hal::kNsPerSecond);
  EXPECT_EQ(robot.left_target(), 100);
  ASSERT_TRUE(robot.first_driven_at());
  EXPECT_LT(*robot.first_driven_at(), hal::kNsPerSecond);
}

TEST(EmulatedThymio, ObeysAndTellsItsSpeedInItsTime) {
  KinematicBody body;
  Thymio robot({.delays = {.command_s = 0.04, .counters_s = 0.03, .body_s = 0.02}}, body, {});
  robot.power_on(0);
  Message set{0, aseba_emulation::type::kSetVariables, {}};
  robot.receive(set.add(1).add(57).add(100), 0);
  constexpr hal::TimeNs kMs = hal::kNsPerMs;
  robot.run_until(59 * kMs);
  EXPECT_EQ(body.command().left_m_s, 0.0);
  EXPECT_EQ(robot.node().words("motor.left.speed")[0], 0);
  robot.run_until(60 * kMs);
  EXPECT_DOUBLE_EQ(body.command().left_m_s, wheel_m_s(100));
  robot.run_until(80 * kMs);
  EXPECT_EQ(robot.node().words("motor.left.speed")[0], 100);  // of 70 ms, looked at every 10
  robot.run_until(560 * kMs);
  body.advance(560 * kMs);
  EXPECT_NEAR(body.pose().x_m, 0.5 * 0.5 * wheel_m_s(100), 2e-3);
}

TEST(EmulatedThymio, RollsOnWheelsThatErr) {
  KinematicBody body({}, {}, {.left = 0.9, .right = 0.9, .delay_s = 0.1});
  body.advance(1);
  body.actuate(1, {.left_m_s = 0.1, .right_m_s = 0.1});
  body.advance(1'100'000'001);
  EXPECT_NEAR(body.pose().x_m, 0.9 * 0.1, 1e-9);
}

TEST(EmulatedThymio, KnowsItsFaults) {
  for (const char* text : {"restart@3s", "program@3s", "silent@5s+2s", "deaf", "lie=name", "drop=0.1", "lose=0.1",
                           "double=0.1@1s", "delay=20ms", "hangup@6s+1s"})
    EXPECT_TRUE(kFaults.parse(text).ok()) << text;
  const std::vector<std::pair<std::string, std::string>> wrong = {{"fire", "there is no fault 'fire'"},
                                                                  {"restart", "say when"},
                                                                  {"drop", "'drop' needs a value"},
                                                                  {"deaf=1", "'deaf' takes no value"},
                                                                  {"lie=colour", "a lie is about size, count or name"},
                                                                  {"drop=2", "from 0 to 1"}};
  for (const auto& [text, why] : wrong) {
    const auto fault = kFaults.parse(text);
    ASSERT_FALSE(fault.ok()) << text;
    EXPECT_THAT(fault.error().message, HasSubstr(why));
    EXPECT_THAT(fault.error().message, HasSubstr("hangup@6s+1s"));
  }
}

TEST(EmulatedThymio, RefusesWhatIsNoLine) {
  const std::atomic<bool> stop{true};
  Options options;
  options.link = "can:can0";
  EXPECT_THAT(run(options, stop).error().message, HasSubstr("takes pty:NAME, serial:DEVICE@115200 or tcp-listen:PORT"));
  options.link = "tcp-listen:x";
  EXPECT_THAT(run(options, stop).error().message, HasSubstr("'x' is no port"));
  options.link = "tcp-listen:0";
  options.node = 0;
  EXPECT_THAT(run(options, stop).error().message, HasSubstr("a node has a number from 1 to 255, not 0"));
}

}  // namespace
}  // namespace tandem::bridges::thymio_emulator
