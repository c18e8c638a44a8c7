// The conversation with an e-puck2's radio against the emulated one, in a time that the test moves.
#include <gmock/gmock.h>

#include "bridges/epuck/driver.hpp"
#include "bridges/epuck/stopper.hpp"
#include "bridges/epuck/wifi_session.hpp"
#include "bridges/epuck_emulator/radio.hpp"
#include "hal/robot/epuck2.hpp"
#include "tests/bridges/link/memory_link.hpp"

namespace tandem::bridges::epuck {
namespace {

using hal::TimeNs;
using testing::HasSubstr;
namespace emulator = epuck_emulator;

constexpr TimeNs kMs = hal::kNsPerMs;
constexpr TimeNs kTick = 100 * kMs;
using Bytes = std::vector<std::uint8_t>;

/// Senses what a test sets, and remembers how it is driven.
class Body final : public emulator::EmulatedBody {
 public:
  emulator::BodySenses sense(TimeNs) override { return senses; }
  void actuate(TimeNs, const emulator::BodyCommand& c) override { command = c; }
  bool moves() const { return command.left_m_s != 0.0 || command.right_m_s != 0.0; }

  emulator::BodySenses senses;
  emulator::BodyCommand command;
};

/// Driver, TCP as a pair of memory links, radio and robot.
class Rig {
 public:
  Rig() : driver(settings()), robot({.variant = emulator::Variant::Epuck2, .selector = 15}, body, {}), radio(robot) {
    plug_in();
    robot.power_on(0);
  }
  void plug_in() {
    auto [a, b] = MemoryLink::make_pair([this] { return now; });
    near = std::move(a);
    far = std::move(b);
    radio.new_host();
  }
  void run(TimeNs duration) {
    for (const TimeNs end = now + duration; now < end;) {
      now += kMs;
      live();
      driver.pump(*near, now);
      if (driver.wants_new_link()) {
        ++new_links;
        driver.link_gone(now);
        plug_in();
      }
    }
  }
  void live() {
    std::array<std::uint8_t, 256> buffer{};
    for (Received r = far->read(buffer); r.size > 0; r = far->read(buffer)) {
      heard.insert(heard.end(), buffer.begin(), buffer.begin() + static_cast<std::ptrdiff_t>(r.size));
      for (std::size_t i = 0; i < r.size && !deaf; ++i) radio.receive(buffer[i], now);
    }
    radio.run_until(now);
    sent.clear();
    radio.take_sent(now, sent);
    if (silent) return;
    held.insert(held.end(), sent.begin(), sent.end());
    if (outage) return;
    sent.swap(held);
    held.clear();
    for (const emulator::SentByte& s : sent) (void)far->write(std::span(&s.byte, 1), 0);
  }
  void ticks(int count, double speed_m_s) {
    for (int i = 0; i < count; ++i) {
      driver.latch(tick++, now);
      driver.robot().port<hal::WheelSpeeds>().set(speed_m_s, speed_m_s);
      driver.commit(now);
      driver.pump(*near, now);
      run(kTick);
    }
  }
  static DriverSettings settings() {
    DriverSettings s;
    s.wire = WireForm::Wifi;
    s.robot.kind = &hal::epuck2::kind();
    s.timing.answer_ns = 250 * kMs;
    return s;
  }

  TimeNs now = hal::kNsPerSecond;
  hal::Tick tick = 0;
  Body body;
  EpuckDriver driver;
  emulator::Firmware robot;
  emulator::Radio radio;
  std::unique_ptr<MemoryLink> near, far;
  std::vector<emulator::SentByte> sent, held;
  Bytes heard;
  bool silent = false, deaf = false;
  bool outage = false;  // what the robot says waits
  int new_links = 0;
};

TEST(EpuckWifi, EncodesTheCommandAsTheRadioTakesIt) {
  Packet packet;
  ASSERT_TRUE(append_wifi_command(packet, {.left = 500, .right = -500, .leds = 0x21, .rgb_percent = {100, 0, 101}}));
  EXPECT_THAT(Bytes(packet.bytes().begin(), packet.bytes().end()),
              (Bytes{0x80, 2, 0, 0xF4, 0x01, 0x0C, 0xFE, 0x21, 100, 0, 100, 0, 0, 0, 0, 0, 0, 0, 0, 0, 0}));
}

TEST(EpuckWifi, CutsTheStreamIntoPackets) {
  using enum WifiReader::Event;
  WifiReader reader;
  EXPECT_EQ(reader.push(3), Empty);
  EXPECT_EQ(reader.push(2), None);
  for (int i = 0; i < 103; ++i) ASSERT_EQ(reader.push(static_cast<std::uint8_t>(i)), None) << i;
  EXPECT_EQ(reader.push(0), Sensors);
  ASSERT_EQ(reader.sensors().size(), kAllSensorsSize);
  EXPECT_EQ(reader.sensors()[102], 102);
  EXPECT_EQ(reader.push(1), None) << "an image that nobody asked for";
  for (int i = 0; i < 38400; ++i) ASSERT_EQ(reader.push(2), None);
  EXPECT_EQ(reader.push(2), None);
  for (int i = 0; i < 103; ++i) reader.push(9);
  EXPECT_EQ(reader.push(9), Sensors);
  EXPECT_EQ(reader.push(4), OutOfStep);
  EXPECT_EQ(reader.push(2), OutOfStep) << "for good";
}

TEST(EpuckWifi, BecomesActiveStoppedAndThenDrives) {
  Rig rig;
  rig.body.command.left_m_s = 0.05;  // as the last program left it
  rig.run(kMs);
  rig.ticks(10, 0.0);
  EXPECT_EQ(rig.driver.state(), SessionState::Active) << rig.driver.session().trouble();
  EXPECT_FALSE(rig.body.moves());
  EXPECT_EQ(rig.driver.session().identity().firmware, Firmware::Epuck2);
  rig.ticks(5, 0.06);
  EXPECT_NEAR(rig.body.command.left_m_s, 0.06, 1e-3);
  EXPECT_EQ(rig.driver.session().epoch(), 1U);
  EXPECT_EQ(rig.heard.size() % kWifiCommandSize, 0U);
}

TEST(EpuckWifi, DrivesAsFastAsAnEpuck2) {
  Rig rig;
  rig.ticks(10, 0.0);
  rig.ticks(3, 1.0);
  EXPECT_NEAR(rig.body.command.left_m_s, hal::epuck2::kind().drive()->max_speed_m_s, 1e-6);
}

TEST(EpuckWifi, TellsEverySensorInSi) {
  Rig rig;
  rig.body.senses.turn_rad_s = {0.1, -0.2, 0.3};
  rig.body.senses.ahead_m = 0.75;
  rig.body.senses.sound = {0.1, 0.2, 0.3, 0.4};
  rig.body.senses.battery_V = 3.9;
  EpuckRobot& robot = rig.driver.robot();
  const auto& gyroscope = robot.sensor<hal::Gyroscope>();
  const auto& ahead = robot.sensor<hal::TimeOfFlight>();
  const auto& cliff = robot.sensor<hal::Cliff>();
  const auto& selector = robot.sensor<hal::Selector>();
  const auto& accelerometer = robot.sensor<hal::Accelerometer>();
  const auto& microphones = robot.sensor<hal::Microphones>();
  const auto& battery = robot.sensor<hal::Battery>();
  const auto& ground = robot.sensor<hal::Ground>();
  rig.ticks(12, 0.0);
  EXPECT_EQ(gyroscope.validity, hal::Validity::Fresh);
  EXPECT_NEAR(gyroscope.rate_rad_s[0], 0.1, 1e-3);
  EXPECT_NEAR(gyroscope.rate_rad_s[1], -0.2, 1e-3);
  EXPECT_NEAR(gyroscope.rate_rad_s[2], 0.3, 1e-3);
  EXPECT_EQ(ahead.validity, hal::Validity::Fresh);
  EXPECT_NEAR(ahead.distance_m, 0.75, 1e-3);
  EXPECT_EQ(selector.validity, hal::Validity::Fresh);
  EXPECT_EQ(selector.position, 15U);
  EXPECT_EQ(accelerometer.validity, hal::Validity::Fresh) << "its zero is found";
  EXPECT_NEAR(accelerometer.force_m_s2[2], 9.81, 0.2);
  EXPECT_EQ(microphones.count, 4U);
  EXPECT_NEAR(microphones.level[3], 0.4, 1e-3);
  EXPECT_NEAR(battery.supply_V, 3.9, 0.01);
  EXPECT_EQ(ground.count, 3U);
  EXPECT_EQ(cliff.validity, hal::Validity::Absent) << "the radio does not tell it";
  EXPECT_THAT(robot.untold(rig.driver.session().layout(), rig.driver.session().samples()), testing::StrEq("cliff"));
}

TEST(EpuckWifi, SetsAllLamps) {
  Rig rig;
  rig.driver.robot().actuator<hal::RingLeds>().set(0, hal::kRed);
  rig.driver.robot().actuator<hal::RingLeds>().set(3, {255, 0, 128});
  rig.driver.robot().actuator<hal::BodyLed>().on = true;
  rig.ticks(12, 0.0);
  EXPECT_EQ(rig.body.command.ring, 1);
  EXPECT_EQ(rig.body.command.rgb[3], 100);
  EXPECT_EQ(rig.body.command.rgb[5], 50);
  EXPECT_TRUE(rig.body.command.body_led);
  EXPECT_FALSE(rig.body.command.front_led);
}

TEST(EpuckWifi, IsStoppedWhenNoCommandsComeAndConfirmsIt) {
  Rig rig;
  rig.ticks(10, 0.0);
  rig.ticks(3, 0.06);
  rig.run(kTick);
  EXPECT_TRUE(rig.body.moves());
  rig.run(900 * kMs);
  EXPECT_FALSE(rig.body.moves());
  EXPECT_EQ(rig.driver.statistics().watchdog_stops, 1U);
  EXPECT_TRUE(rig.driver.at_rest());
  rig.ticks(3, 0.06);
  EXPECT_TRUE(rig.body.moves());
}

TEST(EpuckWifi, StopIsConfirmedByTheWheelCountersAndStays) {
  Rig rig;
  rig.ticks(10, 0.0);
  rig.ticks(5, 0.06);
  rig.driver.stop(rig.now);
  rig.run(20 * kMs);
  EXPECT_FALSE(rig.driver.at_rest()) << "nothing was read yet";
  rig.run(600 * kMs);
  EXPECT_TRUE(rig.driver.at_rest());
  rig.ticks(5, 0.06);
  EXPECT_FALSE(rig.body.moves()) << "until it is resumed";
  rig.driver.resume();
  rig.ticks(3, 0.06);
  EXPECT_TRUE(rig.body.moves());
}

TEST(EpuckWifi, ARobotThatMovesAgainstItsWillIsNoticed) {
  Rig rig;
  rig.ticks(10, 0.0);
  ASSERT_TRUE(rig.driver.at_rest());
  rig.radio.run_until(rig.now);
  for (const std::uint8_t b : Bytes{0xBC, 100, 0, 100, 0, 0}) rig.robot.receive(b, rig.now);  // somebody else says it
  const std::uint64_t epoch = rig.driver.session().epoch();
  rig.ticks(10, 0.0);
  EXPECT_FALSE(rig.body.moves());
  EXPECT_GE(rig.driver.session().epoch(), epoch);
}

TEST(EpuckWifi, SilenceMakesItSuspectThenLostAndOpensTheLinkAnew) {
  Rig rig;
  const auto& ahead = rig.driver.robot().sensor<hal::TimeOfFlight>();
  rig.ticks(10, 0.0);
  rig.ticks(3, 0.06);
  rig.silent = rig.deaf = true;  // switched off: no end of the connection is heard
  rig.ticks(4, 0.06);
  EXPECT_EQ(ahead.validity, hal::Validity::Stale);
  rig.ticks(3, 0.06);
  EXPECT_EQ(rig.driver.state(), SessionState::Suspect);
  rig.ticks(10, 0.06);
  EXPECT_EQ(rig.driver.state(), SessionState::Lost);
  EXPECT_GE(rig.new_links, 1);
  rig.silent = rig.deaf = false;
  rig.ticks(25, 0.06);
  EXPECT_EQ(rig.driver.state(), SessionState::Active) << rig.driver.session().trouble();
  EXPECT_EQ(rig.driver.session().epoch(), 2U);
}

TEST(EpuckWifi, AnAnswerThatIsMissedOnceStopsNobody) {
  Rig rig;
  rig.ticks(10, 0.0);
  rig.ticks(3, 0.06);
  rig.silent = true;
  rig.ticks(3, 0.06);
  rig.silent = false;
  rig.plug_in();  // the stream is out of step else: bytes are missing
  rig.ticks(20, 0.06);
  EXPECT_EQ(rig.driver.state(), SessionState::Active);
}

TEST(EpuckWifi, APacketOfWhichAPartIsMissingIsFoundAndTheLinkOpenedAnew) {
  Rig rig;
  rig.ticks(10, 0.0);
  rig.ticks(5, 0.06);
  rig.radio.cut_next_answer();
  rig.ticks(20, 0.06);
  EXPECT_GE(rig.new_links, 1);
  EXPECT_EQ(rig.driver.state(), SessionState::Active) << rig.driver.session().trouble();
  EXPECT_TRUE(rig.body.moves());
}

TEST(EpuckWifi, ARobotThatRestartsIsStoppedAndFoundAgain) {
  Rig rig;
  rig.ticks(10, 0.0);
  rig.ticks(30, 0.1);
  rig.robot.reset(rig.now, "test");
  rig.ticks(20, 0.1);
  EXPECT_EQ(rig.driver.session().statistics().restarts, 1U);
  EXPECT_EQ(rig.driver.state(), SessionState::Active) << rig.driver.session().trouble();
  EXPECT_GT(rig.driver.odometry().rebased, 0U);
}

TEST(EpuckWifi, ABacklogIsOneReadingNotMany) {
  Rig rig;
  rig.ticks(10, 0.0);
  const auto& encoders = rig.driver.robot().sensor<hal::WheelEncoders>();
  rig.ticks(5, 0.1);
  for (int i = 0; i < 400; ++i) {  // the hub's thread does not run
    rig.now += kMs;
    rig.live();
  }
  rig.ticks(2, 0.1);
  EXPECT_LT(encoders.left_m_s, 0.13F);
  EXPECT_GT(encoders.left_m_s, 0.05F);
}

TEST(EpuckWifi, WhatWaitedDuringAnOutageIsNotTakenForNew) {
  Rig rig;
  const auto& ahead = rig.driver.robot().sensor<hal::TimeOfFlight>();
  rig.body.senses.ahead_m = 1.0;
  rig.ticks(10, 0.0);
  ASSERT_EQ(ahead.validity, hal::Validity::Fresh);
  rig.outage = true;
  rig.ticks(4, 0.0);
  ASSERT_EQ(ahead.validity, hal::Validity::Stale);
  rig.body.senses.ahead_m = 0.2;
  rig.run(20 * kMs);  // what is just being told was measured before
  rig.outage = false;
  for (int i = 0; i < 90; ++i) {
    rig.driver.latch(rig.tick++, rig.now);
    rig.driver.commit(rig.now);
    rig.run(kMs);
    if (ahead.validity == hal::Validity::Fresh) {
      ASSERT_NEAR(ahead.distance_m, 0.2, 1e-3) << i;
    }
  }
  EXPECT_EQ(ahead.validity, hal::Validity::Fresh);
  EXPECT_EQ(rig.driver.session().epoch(), 1U) << "it was not stopped";
}

TEST(EpuckWifi, EndsWithAStopThatIsConfirmed) {
  Rig rig;
  rig.ticks(10, 0.0);
  rig.ticks(5, 0.06);
  rig.driver.shut_down(rig.now);
  rig.run(600 * kMs);
  EXPECT_TRUE(rig.driver.idle());
  EXPECT_TRUE(rig.driver.at_rest());
  EXPECT_FALSE(rig.body.moves());
}

TEST(EpuckWifi, AllocatesAndSendsNothingWhileThereIsNoLink) {
  WifiSession session;
  session.poll(1);
  session.stop(1);
  session.command({}, 2);
  EXPECT_TRUE(session.output().empty());
  EXPECT_EQ(session.state(), SessionState::Absent);
}

}  // namespace
}  // namespace tandem::bridges::epuck
