// A controller's ports, through driver, memory link and a scripted robot, in a time that the test moves.
#include "bridges/epuck/driver.hpp"

#include <cmath>
#include <gmock/gmock.h>
#include <limits>

#include "bridges/epuck/conversions.hpp"
#include "hal/device/body_sensors.hpp"
#include "hal/device/leds.hpp"
#include "hal/device/range_and_bearing.hpp"
#include "hal/device/ring_sensors.hpp"
#include "hal/device/wheels.hpp"
#include "hal/robot/epuck.hpp"
#include "tests/bridges/epuck/scripted_robot.hpp"
#include "tests/bridges/link/faulty_link.hpp"
#include "tests/bridges/link/memory_link.hpp"

namespace tandem::bridges::epuck {
namespace {

const Conversions kUnits{hal::epuck::kind()};

using testing::HasSubstr;

constexpr hal::TimeNs kMs = hal::kNsPerMs;
const double kMax_m_s = hal::epuck::kind().drive()->max_speed_m_s;

struct Rig {
  explicit Rig(DriverSettings settings = {})
      : driver(settings, hal::Log([this](hal::Severity, std::string_view text) { log.emplace_back(text); })) {
    plug_in();
  }
  void plug_in() {
    auto [a, b] = MemoryLink::make_pair([this] { return now; });
    near = std::move(a);
    far = std::move(b);
  }
  void serve_robot() {
    std::array<std::uint8_t, 256> buffer;
    for (Received r = far->read(buffer); r.size > 0; r = far->read(buffer)) {
      const Bytes answer = robot.hear(std::span(buffer.data(), r.size));
      if (!answer.empty()) far->write(answer, 0);
    }
  }
  void run(hal::TimeNs duration) {
    for (const hal::TimeNs end = now + duration; now < end;) {
      now += kMs;
      driver.pump(*near, now);
      driver.tell();
      serve_robot();
    }
    driver.pump(*near, now);
  }
  /// One tick of 100 ms: latch, the controller's writing (done by the test), commit, and the time until the next.
  void tick() {
    driver.latch(ticks++, now);
    driver.commit(now);
    run(100 * kMs);
  }
  void connect() { run(500 * kMs); }

  hal::TimeNs now = 0;
  hal::Tick ticks = 0;
  std::vector<std::string> log;
  ScriptedRobot robot;
  std::unique_ptr<MemoryLink> near, far;
  EpuckDriver driver;
};

TEST(EpuckRobot, HasTheDevicesOfAnEpuck) {
  EpuckRobot robot({});
  EXPECT_EQ(robot.kind().name, "e-puck");
  robot.sensor<hal::Proximity>();
  robot.sensor<hal::Light>();
  robot.sensor<hal::Ground>();
  robot.sensor<hal::Accelerometer>();
  robot.sensor<hal::Microphones>();
  robot.sensor<hal::Battery>();
  robot.sensor<hal::WheelEncoders>();
  robot.sensor<hal::Clock>();
  robot.sensor<hal::RangeAndBearing>();
  robot.actuator<hal::WheelSpeeds>();
  robot.actuator<hal::RingLeds>();
  robot.actuator<hal::BodyLed>();
  robot.actuator<hal::FrontLed>();
  robot.actuator<hal::RangeAndBearingSend>();
  EXPECT_EQ(robot.taken().size(), 14U);
  EXPECT_EQ(&robot.sensor<hal::Proximity>(), &robot.sensor<hal::Proximity>());
  EXPECT_EQ(robot.taken().size(), 14U);
}

TEST(EpuckRobot, AsksOnlyForWhatWasTaken) {
  EpuckRobot robot({});
  EXPECT_EQ(robot.demand(), QuantitySet{Quantity::Encoders});
  robot.sensor<hal::Proximity>();
  robot.actuator<hal::WheelSpeeds>();
  EXPECT_EQ(robot.demand(), (QuantitySet{Quantity::Encoders, Quantity::Proximity}));
}

std::string refusal(EpuckRobot& robot, const hal::PortType& type) {
  try {
    robot.require(type);
  } catch (const hal::DeviceError& e) {
    return e.what();
  }
  return "given";
}

TEST(EpuckRobot, RefusesDevicesThatItHasNotOrThatAreNotListed) {
  EpuckRobot robot({.id = "ep7", .sensors = std::vector<std::string>{"proximity"}});
  EXPECT_EQ(refusal(robot, hal::port_type<hal::Proximity>()), "given");
  EXPECT_THAT(refusal(robot, hal::port_type<hal::Ground>()), HasSubstr("does not list sensor 'ground'"));
  EXPECT_EQ(refusal(robot, hal::port_type<hal::WheelSpeeds>()), "given");
  hal::PortType other = hal::port_type<hal::Proximity>();
  other.layout += 1;
  EXPECT_THAT(refusal(robot, other), HasSubstr("rebuild"));
  other.name = "gripper";
  EXPECT_THAT(refusal(robot, other), HasSubstr("e-puck 'ep7' has no sensor 'gripper'"));
}

TEST(EpuckDriver, FillsThePortsWithWhatTheLastCommitAskedFor) {
  Rig rig;
  const auto& proximity = rig.driver.robot().sensor<hal::Proximity>();
  const auto& light = rig.driver.robot().sensor<hal::Light>();
  const auto& ground = rig.driver.robot().sensor<hal::Ground>();
  const auto& acceleration = rig.driver.robot().sensor<hal::Accelerometer>();
  const auto& battery = rig.driver.robot().sensor<hal::Battery>();
  const auto& sound = rig.driver.robot().sensor<hal::Microphones>();
  const auto& clock = rig.driver.robot().sensor<hal::Clock>();
  EXPECT_EQ(proximity.validity, hal::Validity::Absent);
  rig.connect();
  EXPECT_EQ(rig.driver.state(), SessionState::Active);
  rig.robot.proximity[2] = 4095;
  rig.robot.ambient[0] = 0;
  rig.tick();
  rig.driver.latch(1, rig.now);
  EXPECT_EQ(proximity.count, 8U);
  EXPECT_FLOAT_EQ(proximity.distance_m[2], 0.0F);
  EXPECT_FLOAT_EQ(proximity.distance_m[0], 0.1F);
  EXPECT_FLOAT_EQ(light.level[0], 1.0F);
  EXPECT_FLOAT_EQ(light.level[1], 0.0F);
  EXPECT_FLOAT_EQ(ground.reflectance[0], 1.0F);
  EXPECT_FLOAT_EQ(ground.reflectance[1], 0.0F);
  EXPECT_FLOAT_EQ(acceleration.force_m_s2[2], 9.81F);
  EXPECT_FLOAT_EQ(battery.charge, 0.5F);
  EXPECT_EQ(sound.count, 3U);
  EXPECT_EQ(clock.tick, 1);
  EXPECT_EQ(clock.now_ns, 100 * kMs);
  EXPECT_EQ(proximity.validity, hal::Validity::Fresh);
  EXPECT_GE(proximity.taken_ns, 500 * kMs);
}

TEST(EpuckDriver, TellsFreshStaleAndAbsentApart) {
  Rig rig({.robot = {.tick_ns = 100 * kMs, .origin_ns = 10 * kMs}});
  rig.robot.battery_bytes = 0;
  const auto& proximity = rig.driver.robot().sensor<hal::Proximity>();
  const auto& battery = rig.driver.robot().sensor<hal::Battery>();
  const auto& rab = rig.driver.robot().sensor<hal::RangeAndBearing>();
  rig.connect();
  rig.tick();
  rig.driver.latch(1, rig.now);
  EXPECT_EQ(proximity.validity, hal::Validity::Fresh);
  EXPECT_EQ(battery.validity, hal::Validity::Absent);
  EXPECT_EQ(rab.validity, hal::Validity::Absent);
  const hal::TimeNs taken = proximity.taken_ns;
  rig.now += 300 * kMs;
  rig.driver.latch(2, rig.now);
  EXPECT_EQ(proximity.validity, hal::Validity::Stale);
  EXPECT_EQ(proximity.taken_ns, taken);
}

TEST(EpuckDriver, SendsCommandsAtOnce) {
  Rig rig;
  auto& wheels = rig.driver.robot().actuator<hal::WheelSpeeds>();
  auto& leds = rig.driver.robot().actuator<hal::RingLeds>();
  auto& front = rig.driver.robot().actuator<hal::FrontLed>();
  rig.connect();
  wheels.set(0.05, -0.05);
  leds.set(3, hal::kGreen);
  front.on = true;
  rig.driver.commit(rig.now);
  rig.driver.pump(*rig.near, rig.now);
  rig.serve_robot();
  EXPECT_EQ(rig.robot.left, kUnits.to_steps_per_s(0.05).value);
  EXPECT_EQ(rig.robot.right, -rig.robot.left);
  EXPECT_EQ(rig.robot.leds[3], 1);
  EXPECT_EQ(rig.robot.leds[4], 0);
  EXPECT_EQ(rig.robot.leds[9], 1);
}

TEST(EpuckDriver, ClampsBothWheelsByTheSameFactor) {
  Rig rig;
  auto& wheels = rig.driver.robot().actuator<hal::WheelSpeeds>();
  rig.connect();
  wheels.set(2.0 * kMax_m_s, kMax_m_s);
  rig.tick();
  EXPECT_EQ(rig.robot.left, 1000);
  EXPECT_EQ(rig.robot.right, 500);
  EXPECT_EQ(rig.driver.statistics().clamped, 1U);
}

TEST(EpuckDriver, StandsOnACommandThatIsNoNumber) {
  Rig rig;
  auto& wheels = rig.driver.robot().actuator<hal::WheelSpeeds>();
  rig.connect();
  wheels.set(0.05, 0.05);
  rig.tick();
  wheels.set(std::numeric_limits<double>::quiet_NaN(), 0.05);
  rig.tick();
  EXPECT_EQ(rig.robot.left, 0);
  EXPECT_EQ(rig.robot.right, 0);
  EXPECT_EQ(rig.driver.statistics().not_finite, 1U);
}

TEST(EpuckDriver, DrivesAtOnceWhenFirstConnectedAndStanding) {
  Rig rig;
  auto& wheels = rig.driver.robot().actuator<hal::WheelSpeeds>();
  rig.connect();
  wheels.set(kMax_m_s, kMax_m_s);
  rig.tick();
  EXPECT_EQ(rig.robot.left, 1000);
  EXPECT_EQ(rig.driver.statistics().rearmed, 0U);
}

TEST(EpuckDriver, StopsBeforeItDrivesOnAfterALostLink) {
  Rig rig;
  auto& wheels = rig.driver.robot().actuator<hal::WheelSpeeds>();
  rig.connect();
  wheels.set(kMax_m_s, 0.5 * kMax_m_s);
  rig.tick();
  rig.near->hang_up();
  rig.tick();
  EXPECT_EQ(rig.driver.state(), SessionState::Lost);
  EXPECT_EQ(rig.robot.left, 1000);  // the stock firmware drives on: nobody can reach it

  rig.plug_in();
  rig.robot.speeds.clear();
  for (int i = 0; i < 12; ++i) rig.tick();
  ASSERT_FALSE(rig.robot.speeds.empty());
  EXPECT_EQ(rig.robot.speeds.front(), std::pair(0, 0));
  EXPECT_EQ(rig.robot.left, 1000);
  EXPECT_EQ(rig.robot.right, 500);
  EXPECT_EQ(rig.driver.statistics().rearmed, 1U);
}

TEST(EpuckDriver, StandsAfterARestartUntilItHasAFreshAnswer) {
  Rig rig;
  auto& wheels = rig.driver.robot().actuator<hal::WheelSpeeds>();
  const auto& encoders = rig.driver.robot().sensor<hal::WheelEncoders>();
  rig.connect();
  wheels.set(kMax_m_s, kMax_m_s);
  rig.robot.encoders = {50, 50};
  rig.tick();
  rig.far->write(rig.robot.restart(), 0);
  rig.robot.speeds.clear();
  rig.tick();
  rig.tick();
  for (const auto& [left, right] : rig.robot.speeds) EXPECT_LE(left, 250);
  EXPECT_NEAR(encoders.left_m, kUnits.steps_to_m(50), 1e-9);
  EXPECT_NEAR(rig.driver.odometry().left_m, kUnits.steps_to_m(50), 1e-9);
  EXPECT_EQ(rig.driver.odometry().rebased, 1U);
  rig.run(50 * kMs);
  for (int i = 0; i < 8; ++i) rig.tick();
  EXPECT_EQ(rig.robot.left, 1000);
}

TEST(EpuckDriver, PutsTheLedsBackAfterAnInterruption) {
  Rig rig;
  auto& leds = rig.driver.robot().actuator<hal::RingLeds>();
  rig.connect();
  leds.set(5, hal::kWhite);
  rig.tick();
  rig.far->write(rig.robot.restart(), 0);
  for (int i = 0; i < 5; ++i) rig.tick();
  EXPECT_EQ(rig.robot.leds[5], 1);
}

TEST(EpuckDriver, StopsTheRobotWhenNobodyCommits) {
  Rig rig;
  auto& wheels = rig.driver.robot().actuator<hal::WheelSpeeds>();
  rig.connect();
  wheels.set(0.05, 0.05);
  rig.tick();
  EXPECT_NE(rig.robot.left, 0);
  rig.run(390 * kMs);
  EXPECT_NE(rig.robot.left, 0);
  rig.run(20 * kMs);
  EXPECT_EQ(rig.robot.left, 0);
  EXPECT_EQ(rig.driver.statistics().watchdog_stops, 1U);
  for (int i = 0; i < 6; ++i) rig.tick();
  EXPECT_EQ(rig.robot.left, kUnits.to_steps_per_s(0.05).value);
  EXPECT_EQ(rig.driver.statistics().rearmed, 1U);
}

TEST(EpuckDriver, StaysStoppedUntilResumed) {
  Rig rig;
  auto& wheels = rig.driver.robot().actuator<hal::WheelSpeeds>();
  auto& leds = rig.driver.robot().actuator<hal::RingLeds>();
  rig.connect();
  wheels.set(0.05, 0.05);
  leds.set_all(hal::kRed);
  rig.tick();
  rig.driver.stop(rig.now);
  rig.driver.pump(*rig.near, rig.now);
  rig.serve_robot();
  EXPECT_EQ(rig.robot.left, 0);
  for (int i = 0; i < 3; ++i) rig.tick();
  EXPECT_EQ(rig.robot.left, 0);
  EXPECT_EQ(rig.robot.leds[0], 0);
  rig.driver.resume();
  for (int i = 0; i < 8; ++i) rig.tick();
  EXPECT_EQ(rig.robot.left, kUnits.to_steps_per_s(0.05).value);
}

TEST(EpuckDriver, LeavesTheRobotStoppedAtTheEnd) {
  Rig rig;
  auto& wheels = rig.driver.robot().actuator<hal::WheelSpeeds>();
  rig.connect();
  wheels.set(0.05, 0.05);
  rig.tick();
  rig.driver.shut_down(rig.now);
  rig.run(20 * kMs);
  EXPECT_EQ(rig.robot.left, 0);
  rig.run(200 * kMs);
  EXPECT_EQ(rig.robot.left, 0);
  EXPECT_TRUE(rig.driver.idle());
  EXPECT_EQ(rig.driver.session().statistics().stops_confirmed, 1U);
}

TEST(EpuckDriver, LogsEachChangeOnceWithItsReason) {
  Rig rig;
  rig.connect();
  rig.tick();
  rig.robot.silent = true;
  for (int i = 0; i < 60; ++i) rig.tick();
  EXPECT_THAT(rig.log, testing::ElementsAre(HasSubstr("active, asercom (GCtronic)"), HasSubstr("suspect: no answer"),
                                            HasSubstr("lost: no answer")));
}

TEST(EpuckDriver, RefusesAnAccelerometerThatDoesNotReadGravityAtRestAndSaysSo) {
  Rig rig;
  rig.robot.acceleration = {0, 0, 800};  // of another firmware than this one's version promises
  const auto& accelerometer = rig.driver.robot().sensor<hal::Accelerometer>();
  rig.connect();
  for (int i = 0; i < 5; ++i) rig.tick();
  EXPECT_EQ(accelerometer.validity, hal::Validity::Absent);
  EXPECT_THAT(rig.log, testing::Contains(HasSubstr("at rest instead of 9.8: its readings are not believed")));
  rig.robot.acceleration = {2048, 2048, 2848};
  for (int i = 0; i < 5; ++i) rig.tick();
  EXPECT_EQ(accelerometer.validity, hal::Validity::Fresh);
}

TEST(EpuckDriver, TurnsTheGroundSensorsRound) {
  Rig rig;
  const auto& ground = rig.driver.robot().sensor<hal::Ground>();
  rig.robot.ground = {1023, 512, 0, 0, 0};  // left, centre, right
  rig.connect();
  rig.tick();
  rig.driver.latch(1, rig.now);
  EXPECT_FLOAT_EQ(ground.reflectance[0], 0.0F) << "the kind's first is on the right";
  EXPECT_FLOAT_EQ(ground.reflectance[2], 1.0F);
}

TEST(EpuckDriver, HoldsOutAgainstALinkThatLosesCorruptsAndBreaks) {
  Rig rig;
  auto& wheels = rig.driver.robot().actuator<hal::WheelSpeeds>();
  const auto& proximity = rig.driver.robot().sensor<hal::Proximity>();
  FaultyLink faulty(std::move(rig.near),
                    {.seed = 5, .loss = 0.001, .corruption = 0.0005, .delay_ns = 10 * kMs, .cut = 0.05},
                    [&] { return rig.now; });
  int fresh = 0;
  constexpr int kTicks = 3000;
  for (int i = 0; i < kTicks; ++i) {
    rig.driver.latch(i, rig.now);
    if (proximity.validity == hal::Validity::Fresh) ++fresh;
    wheels.set(0.05, 0.03);
    rig.driver.commit(rig.now);
    for (int ms = 0; ms < 100; ++ms) {
      rig.driver.pump(faulty, rig.now);
      rig.serve_robot();
      rig.now += kMs;
    }
  }
  const SessionStatistics& s = rig.driver.session().statistics();
  EXPECT_GT(fresh, kTicks / 2);
  EXPECT_GT(s.silent + s.cut_short, 10U);
  EXPECT_GT(s.resynchronised, 10U);
  EXPECT_GT(s.links_lost, 5U);
}

}  // namespace
}  // namespace tandem::bridges::epuck
