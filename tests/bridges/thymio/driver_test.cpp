// The driver against the emulated robot, in time that the test turns.
#include "bridges/thymio/driver.hpp"

#include <gmock/gmock.h>

#include "hal/device/body_sensors.hpp"
#include "hal/device/buttons.hpp"
#include "hal/device/leds.hpp"
#include "hal/device/ring_sensors.hpp"
#include "hal/device/speaker.hpp"
#include "hal/device/wheels.hpp"
#include "tests/bridges/thymio/thymio_line.hpp"

namespace tandem::bridges::thymio {
namespace {

using hal::TimeNs;
using testing::HasSubstr;

constexpr TimeNs kMs = hal::kNsPerMs;

class Drive {
 public:
  explicit Drive(const DriverSettings& settings = {}, const emulator::Thymio::Options& options = {})
      : robot(options, body, {}),
        driver(settings, hub_,
               hal::Log([this](hal::Severity, std::string_view text) { log += std::string(text) + "\n"; })) {
    robot.power_on(0);
    hub_.open();
  }
  void pass(TimeNs time) {
    for (const TimeNs until = now + time; now < until; now += kMs) {
      line.live(now);
      if (now % (100 * kMs) == 0) {
        driver.latch(tick++, now);
        if (commits) driver.commit(now);
      } else {
        driver.pump(now);
      }
    }
  }
  std::int16_t word(std::string_view variable, std::size_t i = 0) { return robot.node().words(variable)[i]; }

  emulator::KinematicBody body;
  emulator::Thymio robot;
  ThymioLine line{robot};
  std::string log;
  bool commits = true;
  TimeNs now = 0;
  hal::Tick tick = 0;

 private:
  ThymioLine::HubEnd hub_{line};

 public:
  ThymioDriver driver;
};

TEST(ThymioDriver, LoadsItsProgramAndDrives) {
  Drive drive;
  auto& wheels = drive.driver.robot().actuator<hal::WheelSpeeds>();
  wheels.set(0.08, -0.04);
  drive.pass(1500 * kMs);
  EXPECT_EQ(drive.driver.state(), RobotState::Active) << drive.log;
  EXPECT_EQ(drive.word("motor.left.target"), 200);
  EXPECT_EQ(drive.word("motor.right.target"), -100);
  EXPECT_EQ(drive.driver.wiring().statistics().programs, 1U);
  RobotIdentity who;
  drive.driver.wiring().identify(who);
  EXPECT_EQ(to_text(who), "thymio-II, firmware 14, node 1");
}

TEST(ThymioDriver, TheRobotStopsByItselfWhenTheHubFallsSilent) {
  Drive drive;
  drive.driver.robot().actuator<hal::WheelSpeeds>().set(0.08, 0.08);
  drive.pass(1500 * kMs);
  ASSERT_EQ(drive.word("motor.left.target"), 200);
  // Neither loop nor thread: as after kill -9.
  for (const TimeNs until = drive.now + 800 * kMs; drive.now < until; drive.now += kMs) drive.line.live(drive.now);
  EXPECT_EQ(drive.word("motor.left.target"), 0);
  EXPECT_EQ(drive.word("motor.right.target"), 0);
  drive.pass(200 * kMs);
  EXPECT_EQ(drive.driver.wiring().statistics().lapses, 1U);
  EXPECT_THAT(drive.log, HasSubstr("suspect: ")) << "its readings were old";
  drive.pass(500 * kMs);
  EXPECT_EQ(drive.word("motor.left.target"), 200) << "and drives on";
}

TEST(ThymioDriver, IsStoppedWhenTheLoopHangs) {
  Drive drive;
  drive.driver.robot().actuator<hal::WheelSpeeds>().set(0.08, 0.08);
  drive.pass(1500 * kMs);
  drive.commits = false;
  drive.pass(600 * kMs);
  EXPECT_EQ(drive.word("motor.left.target"), 0);
  EXPECT_EQ(drive.driver.statistics().watchdog_stops + drive.driver.statistics().link_stops, 1U);
  EXPECT_EQ(drive.driver.wiring().statistics().lapses, 0U) << "the driver was faster";
  EXPECT_TRUE(drive.driver.at_rest());
}

TEST(ThymioDriver, ReadsItsSensors) {
  Drive drive;
  auto& robot = drive.driver.robot();
  const auto& proximity = robot.sensor<hal::Proximity>();
  const auto& ground = robot.sensor<hal::Ground>();
  const auto& force = robot.sensor<hal::Accelerometer>();
  const auto& sound = robot.sensor<hal::Microphones>();
  drive.body.surroundings.distance_m[0] = 0.05;
  drive.body.surroundings.distance_m[6] = 0.0;
  drive.body.surroundings.ground = {1.0, 0.0};
  drive.body.surroundings.force_m_s2 = {2.0, -1.0, 9.81};
  drive.body.surroundings.sound = 0.5;
  EXPECT_EQ(proximity.validity, hal::Validity::Absent);
  drive.pass(2000 * kMs);
  EXPECT_EQ(proximity.validity, hal::Validity::Fresh);
  ASSERT_EQ(proximity.count, 7U);
  EXPECT_NEAR(proximity.distance_m[0], 0.05, 1e-4);
  EXPECT_FLOAT_EQ(proximity.distance_m[3], 0.14F) << "nothing there";
  EXPECT_FLOAT_EQ(proximity.distance_m[6], 0.0F);
  EXPECT_FLOAT_EQ(ground.reflectance[0], 1.0F);
  EXPECT_LT(ground.reflectance[1], 0.02F);
  EXPECT_NEAR(force.force_m_s2[0], 2.0, 0.25);
  EXPECT_NEAR(force.force_m_s2[1], -1.0, 0.25);
  EXPECT_NEAR(force.force_m_s2[2], 9.81, 0.25);
  EXPECT_NEAR(sound.level[0], 0.5, 0.01);
}

TEST(ThymioDriver, AddsUpWhatItsWheelsRoll) {
  Drive drive;
  auto& robot = drive.driver.robot();
  const auto& rolled = robot.sensor<hal::WheelEncoders>();
  const auto& place = robot.sensor<hal::Odometry>();
  robot.actuator<hal::WheelSpeeds>().set(0.1, 0.1);
  drive.pass(1500 * kMs);
  const double before = rolled.left_m;
  drive.pass(2000 * kMs);
  EXPECT_NEAR(rolled.left_m - before, 0.2, 0.002);
  EXPECT_NEAR(place.x_m, rolled.left_m, 0.03);
  EXPECT_NEAR(rolled.left_m_s, 0.1, 1e-6);
}

TEST(ThymioDriver, LightsItsLamps) {
  Drive drive;
  drive.driver.robot().actuator<hal::WheelSpeeds>();
  auto& leds = drive.driver.robot().actuator<hal::RingLeds>();
  leds.set(2, hal::kWhite);
  leds.set(hal::thymio::kTop, {255, 128, 0});
  leds.set(hal::thymio::kBottomLeft, hal::kBlue);
  drive.pass(1500 * kMs);
  const auto& rgb = drive.robot.command().rgb;
  const auto color = [&rgb](std::size_t led) { return hal::Rgb{rgb[3 * led], rgb[3 * led + 1], rgb[3 * led + 2]}; };
  EXPECT_EQ(color(2), (hal::Rgb{255, 255, 0})) << "its circle is yellow";
  EXPECT_EQ(color(hal::thymio::kTop), (hal::Rgb{255, 128, 0}));
  EXPECT_EQ(color(hal::thymio::kBottomLeft), hal::kBlue);
  EXPECT_EQ(color(hal::thymio::kBottomRight), hal::kBlack);
  // Another program puts them out; ours is loaded again, and lights them.
  drive.robot.load_other_program(drive.now);
  EXPECT_EQ(drive.robot.command().rgb[3 * hal::thymio::kTop], 0);
  drive.pass(1500 * kMs);
  EXPECT_EQ(drive.robot.command().rgb[3 * hal::thymio::kTop], 255);
  EXPECT_EQ(drive.driver.statistics().restarts, 1U);
}

TEST(ThymioDriver, SoundsATone) {
  Drive drive;
  auto& speaker = drive.driver.robot().actuator<hal::Speaker>();
  drive.pass(1500 * kMs);
  EXPECT_EQ(drive.robot.command().tone_Hz, 0.0);
  speaker.tone_Hz = 440.0F;
  drive.pass(200 * kMs);
  EXPECT_EQ(drive.robot.command().tone_Hz, 440.0);
  drive.pass(3000 * kMs);
  EXPECT_EQ(drive.robot.command().tone_Hz, 440.0) << "on and on";
  speaker.tone_Hz = 0.0F;
  drive.pass(200 * kMs);
  EXPECT_EQ(drive.robot.command().tone_Hz, 0.0);
  speaker.tone_Hz = 880.0F;
  drive.pass(200 * kMs);
  ASSERT_EQ(drive.robot.command().tone_Hz, 880.0);
  drive.driver.stop(drive.now);
  drive.pass(100 * kMs);
  EXPECT_EQ(drive.robot.command().tone_Hz, 0.0);
}

TEST(ThymioDriver, FeelsItsButtons) {
  Drive drive;
  const auto& buttons = drive.driver.robot().sensor<hal::Buttons>();
  drive.body.surroundings.buttons = {false, false, true, false, true};
  drive.pass(1500 * kMs);
  EXPECT_EQ(buttons.validity, hal::Validity::Fresh);
  ASSERT_EQ(buttons.count, 5U);
  EXPECT_FALSE(buttons.pressed[0]);
  EXPECT_TRUE(buttons.pressed[2]);
  EXPECT_TRUE(buttons.pressed[4]);
}

TEST(ThymioDriver, BelievesNoSensorOfARobotThatWasReset) {
  Drive drive;
  const auto& proximity = drive.driver.robot().sensor<hal::Proximity>();
  drive.body.surroundings.distance_m.fill(0.03);
  drive.pass(1500 * kMs);
  ASSERT_NEAR(proximity.distance_m[2], 0.03, 1e-4);
  drive.robot.restart(drive.now, "test");
  for (int i = 0; i < 20; ++i) {
    drive.pass(100 * kMs);
    EXPECT_NEAR(proximity.distance_m[2], 0.03, 1e-4) << "its variables are 0: nothing would be near";
  }
  EXPECT_EQ(proximity.validity, hal::Validity::Fresh);
  EXPECT_THAT(drive.log, HasSubstr("its program is gone"));
}

// As through ASEBA's switch: an answer is often still on its way when the loop latches.
TEST(ThymioDriver, SeesOverASlowLine) {
  for (const char* delay : {"delay=20ms", "delay=35ms", "delay=45ms"}) {
    Drive drive;
    const auto& proximity = drive.driver.robot().sensor<hal::Proximity>();
    drive.driver.robot().actuator<hal::WheelSpeeds>().set(0.08, 0.08);
    drive.body.surroundings.distance_m.fill(0.03);
    drive.line.begin_faults({delay}, 1, 0);
    drive.pass(4000 * kMs);
    EXPECT_EQ(drive.driver.state(), RobotState::Active) << delay;
    EXPECT_NEAR(proximity.distance_m[2], 0.03, 1e-4) << delay;
    int fresh = 0;
    for (int i = 0; i < 20; ++i) {
      drive.pass(100 * kMs);
      fresh += proximity.validity == hal::Validity::Fresh ? 1 : 0;
    }
    EXPECT_EQ(fresh, 20) << delay;
  }
}

TEST(ThymioDriver, SaysWhichOneItIsNot) {
  DriverSettings settings;
  settings.calibration.node = 7;
  Drive drive(settings);
  drive.pass(2000 * kMs);
  EXPECT_NE(drive.driver.state(), RobotState::Active);
  EXPECT_EQ(drive.driver.trouble(), "node 7 is not there");
}

TEST(ThymioDriver, FindsItsNodeByNumber) {
  DriverSettings settings;
  settings.calibration.node = 7;
  Drive drive(settings, {.node = 7});
  drive.driver.robot().actuator<hal::WheelSpeeds>().set(0.08, 0.08);
  drive.pass(1500 * kMs);
  EXPECT_EQ(drive.word("motor.left.target"), 200);
}

TEST(ThymioDriver, AStopHoldsUntilItIsTakenBack) {
  Drive drive;
  drive.driver.robot().actuator<hal::WheelSpeeds>().set(0.08, 0.08);
  drive.pass(1500 * kMs);
  drive.driver.stop(drive.now);
  drive.pass(100 * kMs);
  EXPECT_EQ(drive.word("motor.left.target"), 0);
  EXPECT_TRUE(drive.driver.at_rest());
  drive.pass(500 * kMs);
  EXPECT_EQ(drive.word("motor.left.target"), 0);
  drive.driver.resume();
  drive.pass(300 * kMs);
  EXPECT_EQ(drive.word("motor.left.target"), 200);
  EXPECT_FALSE(drive.driver.at_rest());
}

}  // namespace
}  // namespace tandem::bridges::thymio
