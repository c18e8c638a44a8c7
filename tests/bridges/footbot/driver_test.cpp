// A foot-bot by its ports: what is read, written, and what happens when modules fail. The modules' bytes are made by
// hand.
#include <gmock/gmock.h>
#include <numbers>

#include "hal/device/body_sensors.hpp"
#include "hal/device/distance_scanner.hpp"
#include "hal/device/gripper.hpp"
#include "hal/device/leds.hpp"
#include "hal/device/range_and_bearing.hpp"
#include "hal/device/ring_sensors.hpp"
#include "hal/device/turret.hpp"
#include "hal/device/wheels.hpp"
#include "tests/bridges/footbot/fake_footbot.hpp"

namespace tandem::bridges::footbot {
namespace {

using hal::Validity;
using testing::HasSubstr;

constexpr double kPi = std::numbers::pi;

struct Whole : Bench {
  explicit Whole(DriverSettings settings = default_settings()) : Bench(std::move(settings)) { modules.add_all(); }
};

TEST(FootbotDriver, DrivesTheMotorsAtOnceAfterTheStep) {
  Whole robot;
  auto& wheels = robot.actuator<hal::WheelSpeeds>();
  ASSERT_TRUE(robot.tick_until(RobotState::Active, 10)) << robot.driver.trouble();
  wheels.set(0.1, -0.2);
  robot.driver.commit(robot.now);  // and nothing else: no time passes
  robot.modules.work();
  EXPECT_EQ(robot.modules.word("left motor", "speed"), 24);    // 0.1 / 0.00413976 = 24.16
  EXPECT_EQ(robot.modules.word("right motor", "speed"), -48);  // 48.31
}

TEST(FootbotDriver, ReadsOnlyWhatIsUsed) {
  Whole robot;
  robot.actuator<hal::WheelSpeeds>();
  robot.sensor<hal::Proximity>();
  ASSERT_TRUE(robot.tick_until(RobotState::Active));
  for (const auto& node : robot.modules.nodes) node->reads = 0;
  for (int i = 0; i < 10; ++i) robot.tick();
  EXPECT_EQ(robot.modules["proximity sensors"].reads, 10);
  EXPECT_EQ(robot.modules["left motor"].reads, 10);  // what was written is read back
  for (const char* other : {"distance sensors", "turret", "gripper", "leds", "range and bearing", "base"}) {
    EXPECT_EQ(robot.modules[other].reads, 0) << other;
    EXPECT_EQ(robot.modules[other].writes, 0) << other;
  }
}

TEST(FootbotDriver, ReadsNeighboursInOneMessage) {
  Whole robot;
  robot.sensor<hal::Proximity>();
  robot.sensor<hal::BaseGround>();
  robot.sensor<hal::MotorGround>();
  robot.sensor<hal::Light>();
  ASSERT_TRUE(robot.tick_until(RobotState::Active));
  robot.modules["proximity sensors"].reads = 0;
  for (int i = 0; i < 5; ++i) robot.tick();
  EXPECT_EQ(robot.modules["proximity sensors"].reads, 5);
}

TEST(FootbotDriver, ReadsTheRingSensorsInTheirUnits) {
  Whole robot;
  const auto& proximity = robot.sensor<hal::Proximity>();
  const auto& base = robot.sensor<hal::BaseGround>();
  const auto& motor = robot.sensor<hal::MotorGround>();
  const auto& light = robot.sensor<hal::Light>();
  EXPECT_EQ(proximity.validity, Validity::Absent);
  robot.modules.word("proximity sensors", "bumpers", 5) = 1024;
  robot.modules.word("proximity sensors", "bumpers", 23) = 4096;
  robot.modules.word("proximity sensors", "ground", 3) = 2048;
  robot.modules.word("proximity sensors", "ground", 9) = 512;
  robot.modules.word("proximity sensors", "light", 7) = 4096;
  robot.modules.word("proximity sensors", "light", 8) = 5000;  // more than can be
  ASSERT_TRUE(robot.tick_until(RobotState::Active));
  robot.tick();
  EXPECT_EQ(proximity.validity, Validity::Fresh);
  EXPECT_EQ(proximity.count, 24U);
  EXPECT_FLOAT_EQ(proximity.range_m, 0.1F);
  EXPECT_FLOAT_EQ(proximity.distance_m[0], 0.1F);
  EXPECT_FLOAT_EQ(proximity.distance_m[5], 0.075F);
  EXPECT_FLOAT_EQ(proximity.distance_m[23], 0.0F);
  EXPECT_EQ(base.count, 8U);
  EXPECT_FLOAT_EQ(base.reflectance[3], 0.5F);
  EXPECT_EQ(motor.count, 4U);
  EXPECT_FLOAT_EQ(motor.reflectance[1], 0.5F);
  EXPECT_EQ(light.count, 24U);
  EXPECT_FLOAT_EQ(light.level[7], 1.0F);
  EXPECT_FLOAT_EQ(light.level[8], 1.0F);
}

TEST(FootbotDriver, SumsUpTheEncodersAcrossTheirWrap) {
  Whole robot;
  const auto& encoders = robot.sensor<hal::WheelEncoders>();
  const auto roll = [&](const char* side, std::uint32_t counter) {
    robot.modules.word(side, "odo", 0) = static_cast<std::int16_t>(counter & 0xFFFFU);
    robot.modules.word(side, "odo", 1) = static_cast<std::int16_t>(counter >> 16U);
  };
  roll("left motor", 0x7FFFFF00U);
  roll("right motor", 0xFFFFFFFFU);
  ASSERT_TRUE(robot.tick_until(RobotState::Active));
  robot.tick();
  EXPECT_EQ(encoders.validity, Validity::Fresh);
  EXPECT_EQ(encoders.left_m, 0.0);  // where the counters began means nothing
  roll("left motor", 0x80000100U);  // 512 farther, across the largest int32
  roll("right motor", 0xFFFFFEFFU);
  robot.tick();
  robot.tick();
  EXPECT_NEAR(encoders.left_m, 512 / 48312.0, 1e-9);
  EXPECT_NEAR(encoders.right_m, -256 / 48312.0, 1e-9);
  robot.tick();
  EXPECT_FLOAT_EQ(encoders.left_m_s, 0.0F);
  roll("left motor", 0x80000100U + 483U);
  robot.tick();
  robot.tick();
  EXPECT_NEAR(encoders.left_m_s, 0.1, 0.002);  // 483 pulses are 1 cm, in a tenth of a second
}

TEST(FootbotDriver, DoesNotJumpWhenACounterBeginsAnew) {
  Whole robot;
  const auto& encoders = robot.sensor<hal::WheelEncoders>();
  const auto& odometry = robot.sensor<hal::Odometry>();
  robot.modules.word("left motor", "odo", 1) = 100;  // 6.5 million pulses
  ASSERT_TRUE(robot.tick_until(RobotState::Active));
  robot.tick();
  robot.modules.word("left motor", "odo", 1) = 0;
  for (int i = 0; i < 3; ++i) robot.tick();
  EXPECT_EQ(encoders.left_m, 0.0);
  EXPECT_EQ(odometry.x_m, 0.0);
  EXPECT_EQ(robot.driver.wiring().statistics().counter_jumps, 1U);
}

TEST(FootbotDriver, ReckonsOnAnArc) {
  Whole robot;
  const auto& odometry = robot.sensor<hal::Odometry>();  // nobody takes the encoders themselves
  ASSERT_TRUE(robot.tick_until(RobotState::Active));
  robot.tick();
  // A quarter of a circle to the left with a radius of 0.2 m, in many small steps.
  const double inner = 0.5 * kPi * (0.2 - 0.07) * 48312.0;
  const double outer = 0.5 * kPi * (0.2 + 0.07) * 48312.0;
  for (int i = 1; i <= 100; ++i) {
    const auto left = static_cast<std::uint32_t>(inner * i / 100);
    const auto right = static_cast<std::uint32_t>(outer * i / 100);
    robot.modules.word("left motor", "odo", 0) = static_cast<std::int16_t>(left & 0xFFFFU);
    robot.modules.word("left motor", "odo", 1) = static_cast<std::int16_t>(left >> 16U);
    robot.modules.word("right motor", "odo", 0) = static_cast<std::int16_t>(right & 0xFFFFU);
    robot.modules.word("right motor", "odo", 1) = static_cast<std::int16_t>(right >> 16U);
    robot.tick();
  }
  robot.tick();
  EXPECT_NEAR(odometry.heading_rad, 0.5 * kPi, 1e-3);
  EXPECT_NEAR(odometry.x_m, 0.2, 1e-3);
  EXPECT_NEAR(odometry.y_m, 0.2, 1e-3);
  EXPECT_EQ(odometry.validity, Validity::Fresh);
}

TEST(FootbotDriver, TurnsTheScannerAndKnowsWhereItsHeadsLook) {
  Whole robot;
  const auto& scanner = robot.sensor<hal::DistanceScanner>();
  auto& drive = robot.actuator<hal::ScannerDrive>();
  ASSERT_TRUE(robot.tick_until(RobotState::Active));
  drive.turn(kPi);  // half a turn a second
  robot.modules.word("distance sensors", "scan.angle") = 16384;
  const std::array<std::int16_t, 4> ranges = {17, -1, -2, 99};
  for (std::size_t i = 0; i < 4; ++i) robot.modules.word("distance sensors", "scan.range", i) = ranges[i];
  robot.tick();
  EXPECT_EQ(robot.modules.word("distance sensors", "scan.mode"), 1);
  EXPECT_EQ(robot.modules.word("distance sensors", "scan.speed"), 30);
  robot.tick();
  EXPECT_EQ(scanner.count, 4U);
  EXPECT_EQ(scanner.samples, 1U);
  EXPECT_NEAR(scanner.turn_rad, 0.5 * kPi, 1e-6);
  EXPECT_FLOAT_EQ(scanner.distance(0, 0), 0.17F);
  EXPECT_TRUE(scanner.too_near(1, 0));
  EXPECT_TRUE(scanner.sees_nothing(2, 0));
  EXPECT_FLOAT_EQ(scanner.distance(3, 0), 0.99F);
  EXPECT_NEAR(scanner.angle(0, 0), 0.5 * kPi, 1e-6);
  EXPECT_NEAR(std::fabs(scanner.angle(1, 0)), kPi, 1e-5);
  EXPECT_NEAR(scanner.angle(2, 0), -0.5 * kPi, 1e-6);
  EXPECT_NEAR(scanner.angle(3, 0), 0.0, 1e-6);
}

TEST(FootbotDriver, TurnsTheTurretAndGrips) {
  Whole robot;
  const auto& encoder = robot.sensor<hal::TurretEncoder>();
  const auto& claws = robot.sensor<hal::Gripper>();
  auto& turret = robot.actuator<hal::TurretDrive>();
  auto& gripper = robot.actuator<hal::GripperDrive>();
  ASSERT_TRUE(robot.tick_until(RobotState::Active));
  turret.go_to(-0.5 * kPi);
  gripper.lock();
  robot.modules.word("turret", "turret.angle") = 32700;
  robot.tick();
  EXPECT_EQ(robot.modules.word("turret", "turret.mode"), 3);
  EXPECT_EQ(robot.modules.word("turret", "turret.target"), -16384);
  EXPECT_EQ(robot.modules.word("gripper", "gripper.target"), 16384);
  robot.modules.word("turret", "turret.angle") = -32636;  // 200 counts on, across the half turn
  robot.modules.word("gripper", "gripper.angle") = 16384;
  robot.modules.word("gripper", "gripper.busy") = 1;
  robot.tick();
  robot.tick();
  EXPECT_NEAR(encoder.angle_rad, -32636.0 / 32768.0 * kPi, 1e-9);
  EXPECT_TRUE(claws.busy);
  EXPECT_FALSE(claws.holding);
  robot.modules.word("gripper", "gripper.busy") = 0;
  robot.tick();
  robot.tick();
  EXPECT_TRUE(claws.holding);
  EXPECT_NEAR(claws.aperture_rad, 0.5 * kPi, 1e-6);
}

TEST(FootbotDriver, SeesTheTurretsSpeedAcrossTheHalfTurn) {
  Whole robot;
  const auto& encoder = robot.sensor<hal::TurretEncoder>();
  robot.modules.word("turret", "turret.angle") = 32700;
  ASSERT_TRUE(robot.tick_until(RobotState::Active));
  robot.tick();
  robot.modules.word("turret", "turret.angle") = -32636;
  robot.tick();
  robot.driver.latch(robot.ticks, robot.now);
  EXPECT_NEAR(encoder.speed_rad_s, 200.0 / 32768.0 * kPi / 0.1, 1e-3);
}

TEST(FootbotDriver, LightsTheRingAndTheBeacon) {
  Whole robot;
  auto& leds = robot.actuator<hal::RingLeds>();
  ASSERT_TRUE(robot.tick_until(RobotState::Active));
  leds.set(0, {1, 2, 3});
  leds.set(11, {255, 128, 64});
  leds.set(12, {9, 8, 7});
  robot.tick();
  EXPECT_EQ(robot.modules.word("leds", "led.red", 0), 1);
  EXPECT_EQ(robot.modules.word("leds", "led.green", 0), 2);
  EXPECT_EQ(robot.modules.word("leds", "led.blue", 0), 3);
  EXPECT_EQ(robot.modules.word("leds", "led.red", 11), 255);
  EXPECT_EQ(robot.modules.word("leds", "led.blue", 11), 64);
  EXPECT_EQ(robot.modules.word("leds", "beacon", 0), 9);
  EXPECT_EQ(robot.modules.word("leds", "beacon", 2), 7);
}

TEST(FootbotDriver, SendsAndReceivesMessages) {
  Whole robot;
  const auto& heard = robot.sensor<hal::RangeAndBearing>();
  auto& send = robot.actuator<hal::RangeAndBearingSend>();
  ASSERT_TRUE(robot.tick_until(RobotState::Active));
  send.sending = true;
  send.size = 3;
  send.payload = {0x11, 0x22, 0xFF, 0x44};
  FakeNode& radio = robot.modules["range and bearing"];
  FakeNode::Bytes words;
  for (const int word : {1500, -16384, 8192, 0x0201, 0x0403, 0x0605, 0x0807, 0x0A09}) FakeNode::put(words, word);
  radio.say(0, words);
  words[0] = 100;  // nearer
  words[1] = 0;
  radio.say(0, words);
  words.resize(6);
  radio.say(0, words);                                  // not as the map says
  radio.say(7, words);                                  // another event
  robot.modules["turret"].say(0, FakeNode::Bytes(16));  // the same event, but not of the radio
  robot.tick();
  EXPECT_EQ(robot.modules.word("range and bearing", "rab.tx", 0), 0x2211);
  EXPECT_EQ(robot.modules.word("range and bearing", "rab.tx", 1), 0x00FF);  // bytes beyond the size are 0
  robot.driver.latch(robot.ticks, robot.now);
  ASSERT_EQ(heard.count, 2U);
  EXPECT_EQ(heard.validity, Validity::Fresh);
  EXPECT_FLOAT_EQ(heard.range_m[0], 0.1F);
  EXPECT_FLOAT_EQ(heard.range_m[1], 1.5F);
  EXPECT_NEAR(heard.bearing_rad[1], -0.5 * kPi, 1e-6);
  EXPECT_NEAR(heard.elevation_rad[1], 0.25 * kPi, 1e-6);
  EXPECT_EQ(heard.size[1], 10);
  for (int i = 0; i < 10; ++i) EXPECT_EQ(heard.message(1)[i], i + 1);
  EXPECT_EQ(robot.driver.wiring().statistics().packets_unfit, 1U);
  robot.tick();
  EXPECT_EQ(heard.count, 0U);  // messages are of one tick
  send.sending = false;
  robot.tick();
  EXPECT_EQ(robot.modules.word("range and bearing", "rab.tx", 0), 0);
}

TEST(FootbotDriver, ReadsTheBodysSensors) {
  Whole robot;
  const auto& battery = robot.sensor<hal::Battery>();
  const auto& force = robot.sensor<hal::Accelerometer>();
  const auto& turn = robot.sensor<hal::Gyroscope>();
  robot.modules.word("base", "battery") = 3800;
  robot.modules.word("base", "acc", 2) = 1000;
  robot.modules.word("base", "gyro") = -900;
  for (int i = 0; i < 12; ++i) robot.tick();
  EXPECT_FLOAT_EQ(battery.supply_V, 3.8F);
  EXPECT_NEAR(battery.charge, 0.5, 1e-6);
  EXPECT_EQ(battery.validity, Validity::Fresh);  // though it is read once a second only
  EXPECT_FLOAT_EQ(force.force_m_s2[2], 9.81F);
  EXPECT_NEAR(turn.rate_rad_s[2], -0.5 * kPi, 1e-6);
  EXPECT_FLOAT_EQ(turn.rate_rad_s[0], 0.0F);
}

TEST(FootbotDriver, ReadsSlowVariablesSeldom) {
  Whole robot;
  robot.sensor<hal::Battery>();
  ASSERT_TRUE(robot.tick_until(RobotState::Active));
  robot.modules["base"].reads = 0;
  for (int i = 0; i < 40; ++i) robot.tick();
  EXPECT_THAT(robot.modules["base"].reads, testing::AllOf(testing::Ge(3), testing::Le(5)));
}

TEST(FootbotDriver, ReadingsAreYoungWhenTheControllerSeesThem) {
  Whole robot;
  const auto& proximity = robot.sensor<hal::Proximity>();
  const auto& encoders = robot.sensor<hal::WheelEncoders>();
  ASSERT_TRUE(robot.tick_until(RobotState::Active));
  robot.driver.robot().set_origin(0);
  for (int i = 0; i < 5; ++i) robot.tick();
  for (int i = 0; i < 20; ++i) {
    robot.driver.latch(robot.ticks, robot.now);
    EXPECT_LE(robot.now - proximity.taken_ns, 15 * kMs) << i;
    EXPECT_LE(robot.now - encoders.taken_ns, 15 * kMs) << i;
    robot.tick();
  }
}

TEST(FootbotDriver, AStallOfOurOwnThreadIsNoLostLink) {
  DriverSettings settings = Bench::default_settings();
  settings.command_timeout_ns = 2000 * kMs;
  Whole robot(settings);
  robot.actuator<hal::WheelSpeeds>().set(0.1, 0.1);
  ASSERT_TRUE(robot.tick_until(RobotState::Active));
  for (int i = 0; i < 5; ++i) robot.tick();
  for (const hal::TimeNs stall : {400 * kMs, 900 * kMs}) {
    robot.now += stall;
    robot.driver.pump(robot.now);
    EXPECT_EQ(robot.driver.state(), RobotState::Active);
    for (int i = 0; i < 10; ++i) robot.tick();
  }
  EXPECT_EQ(robot.driver.statistics().link_stops, 0U);
  EXPECT_EQ(robot.driver.statistics().stalls, 2U);
}

TEST(FootbotDriver, LinesOfItsNodesNameTheRobot) {
  Whole robot;
  ASSERT_TRUE(robot.tick_until(RobotState::Active));
  EXPECT_THAT(robot.said, HasSubstr("foot-bot 'fb': node 1 'left motor' is ready"));
}

TEST(FootbotDriver, ScannerHeadsThatNobodyTellsOfSeeNothing) {
  Whole robot;
  const auto& scanner = robot.sensor<hal::DistanceScanner>();
  EXPECT_EQ(scanner.distance_m[0], scanner.short_max_m);
  EXPECT_EQ(scanner.distance_m[1], scanner.long_max_m);
}

TEST(FootbotDriver, StampsReadingsAndLetsThemGrowOld) {
  Whole robot;
  const auto& proximity = robot.sensor<hal::Proximity>();
  ASSERT_TRUE(robot.tick_until(RobotState::Active));
  robot.tick();
  robot.driver.robot().set_origin(robot.now);
  robot.tick();
  robot.driver.latch(1, robot.now);
  EXPECT_EQ(proximity.validity, Validity::Fresh);
  EXPECT_GE(proximity.taken_ns, 85 * kMs);  // just before the tick at 100 ms
  EXPECT_LE(proximity.taken_ns, 100 * kMs);
  const hal::TimeNs taken = proximity.taken_ns;
  robot.modules["proximity sensors"].answers_reads = false;
  robot.modules.word("proximity sensors", "bumpers", 0) = 4096;
  robot.pass(160 * kMs);
  robot.driver.latch(2, robot.now);
  EXPECT_EQ(proximity.validity, Validity::Fresh);
  robot.pass(60 * kMs);
  robot.driver.latch(3, robot.now);
  EXPECT_EQ(proximity.validity, Validity::Stale);
  EXPECT_EQ(proximity.taken_ns, taken);
  EXPECT_FLOAT_EQ(proximity.distance_m[0], 0.1F);  // the last value that was read
}

// --- safety ---

TEST(FootbotSafety, WritesRestBeforeAnythingElse) {
  Whole robot;
  robot.modules.word("left motor", "speed") = 50;  // left over from somebody else
  auto& wheels = robot.actuator<hal::WheelSpeeds>();
  wheels.set(0.1, 0.1);
  bool rested = false;
  for (int i = 0; i < 1000 && robot.driver.state() != RobotState::Active; ++i) {
    robot.pass(kMs);
    rested = rested || robot.modules.word("left motor", "speed") == 0;
    EXPECT_THAT(robot.modules.word("left motor", "speed"), testing::AnyOf(0, 50));
  }
  EXPECT_TRUE(rested);
}

TEST(FootbotSafety, ClampsAndRefusesSpeeds) {
  Whole robot;
  auto& wheels = robot.actuator<hal::WheelSpeeds>();
  ASSERT_TRUE(robot.tick_until(RobotState::Active));
  wheels.set(0.6, 0.3);
  robot.tick();
  EXPECT_EQ(robot.modules.word("left motor", "speed"), 72);   // 0.3 m/s
  EXPECT_EQ(robot.modules.word("right motor", "speed"), 36);  // the curve stays the same
  EXPECT_EQ(robot.driver.statistics().clamped, 1U);
  EXPECT_EQ(wheels.left_m_s, 0.6);  // what the controller wrote is his
  wheels.set(std::numeric_limits<double>::quiet_NaN(), 0.3);
  robot.tick();
  EXPECT_EQ(robot.modules.word("left motor", "speed"), 0);
  EXPECT_EQ(robot.modules.word("right motor", "speed"), 0);
  EXPECT_EQ(robot.driver.statistics().not_finite, 1U);
}

/// Drives a whole robot at full tilt, with everything that moves.
void drive(Whole& robot) {
  robot.actuator<hal::WheelSpeeds>().set(0.1, 0.1);
  robot.actuator<hal::TurretDrive>().turn(kPi / 4);
  robot.actuator<hal::GripperDrive>().lock();
  robot.actuator<hal::ScannerDrive>().turn(kPi);
  ASSERT_TRUE(robot.tick_until(RobotState::Active)) << robot.driver.trouble();
  for (int i = 0; i < 8; ++i) robot.tick();
  ASSERT_EQ(robot.modules.word("left motor", "speed"), 24);
  ASSERT_EQ(robot.modules.word("turret", "turret.speed"), 2);
}

void expect_rest(Whole& robot) {
  EXPECT_EQ(robot.modules.word("left motor", "speed"), 0);
  EXPECT_EQ(robot.modules.word("right motor", "speed"), 0);
  EXPECT_EQ(robot.modules.word("turret", "turret.mode"), 1);  // passive
  EXPECT_EQ(robot.modules.word("turret", "turret.speed"), 0);
  EXPECT_EQ(robot.modules.word("gripper", "gripper.target"), 0);
  EXPECT_EQ(robot.modules.word("distance sensors", "scan.mode"), 0);
}

TEST(FootbotSafety, StopsWhenAskedAndSaysSoOnlyWhenTheMotorsConfirm) {
  Whole robot;
  drive(robot);
  EXPECT_FALSE(robot.driver.at_rest());
  robot.driver.stop(robot.now);
  EXPECT_FALSE(robot.driver.at_rest());
  robot.pass(kMs);
  expect_rest(robot);
  robot.pass(10 * kMs);
  EXPECT_TRUE(robot.driver.at_rest());
  for (int i = 0; i < 5; ++i) robot.tick();
  expect_rest(robot);  // whatever the controller says
  EXPECT_TRUE(robot.driver.at_rest());
  robot.driver.resume();
  robot.tick();
  EXPECT_FALSE(robot.driver.at_rest());
  EXPECT_EQ(robot.modules.word("left motor", "speed"), 24);
}

TEST(FootbotSafety, SaysStopAgainUntilItIsHeard) {
  Whole robot;
  drive(robot);
  robot.bus.set_full(true);  // nothing leaves
  robot.driver.stop(robot.now);
  robot.pass(200 * kMs);
  EXPECT_EQ(robot.modules.word("left motor", "speed"), 24);
  EXPECT_FALSE(robot.driver.at_rest());
  robot.bus.set_full(false);
  robot.pass(60 * kMs);
  expect_rest(robot);
  robot.pass(60 * kMs);
  EXPECT_TRUE(robot.driver.at_rest());
}

TEST(FootbotSafety, StopsWhenTheLoopHangs) {
  Whole robot;
  drive(robot);
  robot.pass(390 * kMs);
  EXPECT_EQ(robot.modules.word("left motor", "speed"), 24);
  robot.pass(20 * kMs);
  expect_rest(robot);
  EXPECT_EQ(robot.driver.statistics().watchdog_stops, 1U);
  EXPECT_THAT(robot.said, HasSubstr("no commands came"));
  for (int i = 0; i < 8; ++i) robot.tick();
  EXPECT_EQ(robot.modules.word("left motor", "speed"), 24);  // with the next commits it drives on
}

TEST(FootbotSafety, StopsTheOtherMotorWhenOneIsGone) {
  Whole robot;
  drive(robot);
  robot.modules["right motor"].on = false;
  for (int i = 0; i < 5; ++i) robot.tick();
  EXPECT_NE(robot.driver.state(), RobotState::Active);
  EXPECT_EQ(robot.modules.word("left motor", "speed"), 0);
  EXPECT_EQ(robot.driver.statistics().link_stops, 1U);
  for (int i = 0; i < 15; ++i) robot.tick();
  EXPECT_EQ(robot.driver.state(), RobotState::Lost);
  EXPECT_THAT(robot.driver.trouble(), HasSubstr("'right motor' is lost"));
  robot.modules["right motor"].on = true;
  ASSERT_TRUE(robot.tick_until(RobotState::Active, 10)) << robot.driver.trouble();
  EXPECT_EQ(robot.driver.statistics().recovered, 1U);
  for (int i = 0; i < 8; ++i) robot.tick();
  EXPECT_EQ(robot.modules.word("right motor", "speed"), 24);
}

TEST(FootbotSafety, StopsWithoutTheSensorThatItsControllerUses) {
  Whole robot;
  robot.sensor<hal::Proximity>();
  drive(robot);
  robot.modules["proximity sensors"].on = false;
  for (int i = 0; i < 5; ++i) robot.tick();
  expect_rest(robot);
}

TEST(FootbotSafety, DrivesOnWithoutWhatIsNotNeeded) {
  Whole robot;
  const auto& battery = robot.sensor<hal::Battery>();
  robot.actuator<hal::RingLeds>().set_all(hal::kRed);
  drive(robot);
  robot.modules["leds"].on = false;
  robot.modules["base"].on = false;
  for (int i = 0; i < 30; ++i) robot.tick();
  EXPECT_EQ(robot.driver.state(), RobotState::Active);
  EXPECT_EQ(robot.modules.word("left motor", "speed"), 24);
  EXPECT_EQ(battery.validity, Validity::Stale);
  EXPECT_THAT(robot.driver.trouble(), HasSubstr("'leds' is lost"));
  robot.modules["leds"].on = true;
  robot.modules["leds"].memory.assign(robot.modules["leds"].memory.size(), 0);
  for (int i = 0; i < 12; ++i) robot.tick();
  EXPECT_EQ(robot.modules.word("leds", "led.red", 4), 255);  // written anew
  EXPECT_EQ(robot.driver.trouble(), "node 'base' is lost");
}

TEST(FootbotSafety, ComesBackWithinASecondAfterTheBusWasOff) {
  Whole robot;
  drive(robot);
  robot.bus.set_state(BusState::BusOff);
  for (int i = 0; i < 30; ++i) robot.tick();
  EXPECT_EQ(robot.driver.state(), RobotState::Lost);
  EXPECT_EQ(robot.driver.trouble(), "nothing passes on the link");
  // The modules were out of reach and drove on; before anything else they are stopped.
  EXPECT_EQ(robot.modules.word("left motor", "speed"), 24);
  robot.bus.set_state(BusState::Active);
  std::vector<int> speeds;
  bool rested = false;
  ASSERT_TRUE([&] {
    for (int i = 0; i < 10; ++i) {
      robot.tick();
      rested = rested || robot.modules.word("left motor", "speed") == 0;
      if (robot.driver.state() == RobotState::Active) return true;
    }
    return false;
  }()) << robot.driver.trouble();
  EXPECT_TRUE(rested);
  robot.tick();
  EXPECT_EQ(robot.modules.word("left motor", "speed"), 24);
}

TEST(FootbotSafety, WritesAgainWhatAModuleForgot) {
  Whole robot;
  drive(robot);
  robot.modules.word("left motor", "speed") = 0;  // it restarted so quickly that nobody saw it
  for (int i = 0; i < 10; ++i) robot.tick();
  EXPECT_EQ(robot.modules.word("left motor", "speed"), 24);
  EXPECT_EQ(robot.driver.statistics().restarts, 1U);
  robot.modules.word("turret", "turret.mode") = 0;
  for (int i = 0; i < 6; ++i) robot.tick();
  EXPECT_EQ(robot.modules.word("turret", "turret.mode"), 2);  // half a second later: it is not read back
}

TEST(FootbotSafety, StopsOnceWhenAModuleRestarts) {
  Whole robot;
  drive(robot);
  FakeNode& left = robot.modules["left motor"];
  // While it drives: its memory is empty, and the other wheel must not go on alone.
  left.memory.assign(left.memory.size(), 0);
  robot.tick();
  ASSERT_EQ(robot.driver.statistics().restarts, 1U);
  EXPECT_EQ(robot.modules.word("right motor", "speed"), 0);
  for (int i = 0; i < 20; ++i) robot.tick();
  EXPECT_EQ(robot.modules.word("left motor", "speed"), 24);
  EXPECT_EQ(robot.driver.statistics().restarts, 1U);
  EXPECT_EQ(robot.driver.statistics().link_stops, 0U);
  // While it does not answer for so long that it is suspect, and is told to rest: its counter tells.
  robot.modules.word("left motor", "odo") = 5000;
  for (int i = 0; i < 5; ++i) robot.tick();
  left.on = false;
  for (int i = 0; i < 8; ++i) robot.tick();
  EXPECT_NE(robot.driver.state(), RobotState::Active);
  left.memory.assign(left.memory.size(), 0);
  left.on = true;
  for (int i = 0; i < 10; ++i) robot.tick();
  EXPECT_EQ(robot.driver.statistics().restarts, 2U);
  // One that was silent, and kept its memory, has not restarted.
  robot.modules.word("left motor", "odo") = 5000;
  for (int i = 0; i < 5; ++i) robot.tick();
  left.on = false;
  for (int i = 0; i < 8; ++i) robot.tick();
  left.on = true;
  for (int i = 0; i < 20; ++i) robot.tick();
  EXPECT_EQ(robot.driver.state(), RobotState::Active);
  EXPECT_EQ(robot.driver.statistics().restarts, 2U);
}

TEST(FootbotSafety, WritesNothingWhenItOnlyLooks) {
  DriverSettings settings = Bench::default_settings();
  settings.observe = true;
  Whole robot(settings);
  robot.actuator<hal::WheelSpeeds>().set(0.1, 0.1);
  const auto& proximity = robot.sensor<hal::Proximity>();
  robot.modules.word("left motor", "speed") = 33;
  for (int i = 0; i < 20; ++i) robot.tick();
  EXPECT_EQ(robot.driver.state(), RobotState::Active);
  EXPECT_EQ(proximity.validity, Validity::Fresh);
  robot.driver.stop(robot.now);
  robot.pass(100 * kMs);
  for (const auto& node : robot.modules.nodes) EXPECT_EQ(node->writes, 0) << node->name;
}

TEST(FootbotSafety, TellsTheMessagesThatHaveItRest) {
  Whole robot;
  robot.actuator<hal::WheelSpeeds>();
  EXPECT_TRUE(robot.driver.wiring().rest_messages().empty());
  ASSERT_TRUE(robot.tick_until(RobotState::Active));
  const auto messages = robot.driver.wiring().rest_messages();
  ASSERT_EQ(messages.size(), 2U);
  EXPECT_EQ(messages[0].type, 0xA00C);
  EXPECT_EQ(messages[0].payload, (std::vector<std::uint8_t>{1, 0, 34, 0, 0, 0}));
  EXPECT_EQ(messages[1].payload, (std::vector<std::uint8_t>{2, 0, 34, 0, 0, 0}));
}

}  // namespace
}  // namespace tandem::bridges::footbot
