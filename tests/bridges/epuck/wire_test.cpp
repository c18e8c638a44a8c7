// The driver against the emulated firmware over a line of 115200 baud: ages, stamps, stalls, outages, lost bytes.
#include <gtest/gtest.h>

#include "bridges/epuck/stop.hpp"
#include "hal/device/body_sensors.hpp"
#include "hal/device/ring_sensors.hpp"
#include "hal/device/wheels.hpp"
#include "hal/robot/epuck2.hpp"
#include "tests/bridges/epuck/wire_rig.hpp"

namespace tandem::bridges::epuck {
namespace {

constexpr double kCruise_m_s = 0.05;

DriverSettings ticking(hal::TimeNs tick_ns) {
  DriverSettings settings;
  settings.robot.tick_ns = tick_ns;
  return settings;
}

/// Takes every sensor, so that questions and answers are the longest.
hal::WheelSpeeds& take_all(WireRig& rig) {
  EpuckRobot& robot = rig.driver.robot();
  robot.sensor<hal::Proximity>();
  robot.sensor<hal::Light>();
  robot.sensor<hal::Ground>();
  robot.sensor<hal::Accelerometer>();
  robot.sensor<hal::Microphones>();
  robot.sensor<hal::Battery>();
  robot.sensor<hal::WheelEncoders>();
  return robot.actuator<hal::WheelSpeeds>();
}

TEST(EpuckWire, IsActiveWithinHalfASecond) {
  for (const auto variant : {epuck_emulator::Variant::Btcom, epuck_emulator::Variant::Gctronic,
                             epuck_emulator::Variant::Webots, epuck_emulator::Variant::Epuck2}) {
    WireRig rig({}, 1, variant);
    rig.run(500 * kMs);
    EXPECT_EQ(rig.driver.state(), SessionState::Active);
    EXPECT_EQ(rig.driver.session().statistics().handshake_failures, 0U);
  }
}

TEST(EpuckWire, ReadingsAreAtMost15MsOldAtControlAtTenHertz) {
  WireRig rig(ticking(100 * kMs));
  auto& wheels = take_all(rig);
  rig.run(500 * kMs);
  hal::TimeNs oldest = 0;
  for (int i = 0; i < 100; ++i) {
    if (i > 3) oldest = std::max(oldest, rig.now - rig.body.sensed_ns);
    rig.tick(100 * kMs, [&] { wheels.set(0.001 * i, kCruise_m_s); });
  }
  EXPECT_LE(oldest, 15 * kMs);
  EXPECT_GT(oldest, 2 * kMs);
  EXPECT_LE(rig.driver.statistics().late_answers, 1U) << "the first, before the rhythm was known";
}

TEST(EpuckWire, ReadingsAreAsFreshWhenTheLineIsSlow) {
  WireRig rig(ticking(100 * kMs));
  take_all(rig);
  rig.to_robot.delay_ns = rig.to_host.delay_ns = 10 * kMs;  // Bluetooth
  rig.run(800 * kMs);
  hal::TimeNs oldest = 0;
  for (int i = 0; i < 100; ++i) {
    if (i > 10) oldest = std::max(oldest, rig.now - rig.body.sensed_ns);
    rig.tick(100 * kMs);
  }
  EXPECT_LE(oldest, 25 * kMs);
}

TEST(EpuckWire, StampsReadingsWhenTheRobotMeasuredThem) {
  for (const hal::TimeNs delay_ns : {0 * kMs, 40 * kMs}) {
    WireRig rig(ticking(200 * kMs));
    take_all(rig);
    const auto& encoders = rig.driver.robot().sensor<hal::WheelEncoders>();
    rig.to_robot.delay_ns = rig.to_host.delay_ns = delay_ns;
    rig.run(1500 * kMs);
    for (int i = 0; i < 30; ++i) {
      rig.tick(200 * kMs, [&] {
        const hal::TimeNs wrong = std::abs(encoders.taken_ns - rig.body.sensed_ns);
        if (i > 5) {
          EXPECT_LE(wrong, 3 * kMs / 2) << "delay " << delay_ns / kMs << " ms";
        }
      });
    }
  }
}

TEST(EpuckWire, NeverTimesOutFalselyAt50And100HertzOnAMachineThatStalls) {
  for (const hal::TimeNs tick_ns : {20 * kMs, 10 * kMs}) {
    WireRig rig(ticking(tick_ns), 7);
    auto& wheels = take_all(rig);
    rig.run(500 * kMs);
    std::mt19937 chance(3);
    for (int i = 0; i < 12'000; ++i) {
      if (rig.stalled_until <= rig.now && chance() % 50 == 0)
        rig.stalled_until = rig.now + static_cast<hal::TimeNs>(chance() % 200) * kMs;
      const bool late = rig.stalled_until > rig.now;  // so is the loop
      if (late)
        rig.run(tick_ns);
      else
        rig.tick(tick_ns, [&] { wheels.set(kCruise_m_s, kCruise_m_s); });
    }
    const SessionStatistics& s = rig.driver.session().statistics();
    EXPECT_EQ(rig.driver.session().epoch(), 1U)
        << tick_ns / kMs << " ms: " << s.silent << " silent, " << s.cut_short << " cut short, " << s.unasked_bytes
        << " unasked, " << s.wrong_speeds << " wrong speeds, " << s.encoder_jumps << " jumps, " << s.stops << " stops";
    EXPECT_EQ(rig.driver.statistics().watchdog_stops, 0U);
    EXPECT_GT(rig.driver.statistics().stalls, 20U);
  }
}

/// An emulated robot's program waits for its turn, that of the hub does not.
TEST(EpuckWire, NeverStopsARobotWhoseAnswersAreUpTo200MsLate) {
  for (const hal::TimeNs tick_ns : {100 * kMs, 20 * kMs, 10 * kMs}) {
    WireRig rig(ticking(tick_ns), 7);
    auto& wheels = take_all(rig);
    const auto& encoders = rig.driver.robot().sensor<hal::WheelEncoders>();
    rig.run(500 * kMs);
    std::mt19937 chance(3);
    hal::TimeNs youngest = 0;
    for (int i = 0; i < 6'000; ++i) {
      if (rig.robot_stalled_until <= rig.now && chance() % 20 == 0)
        rig.robot_stalled_until = rig.now + static_cast<hal::TimeNs>(chance() % 200) * kMs;
      const double turn_m_s = i / 40 % 2 == 0 ? 0.01 : -0.01;
      rig.tick(tick_ns, [&] {
        wheels.set(kCruise_m_s + turn_m_s, kCruise_m_s - turn_m_s);
        youngest = std::max(youngest, encoders.taken_ns - rig.body.sensed_ns);
      });
    }
    const SessionStatistics& s = rig.driver.session().statistics();
    EXPECT_EQ(rig.driver.session().epoch(), 1U)
        << tick_ns / kMs << " ms: " << s.silent << " silent, " << s.cut_short << " cut short, " << s.unasked_bytes
        << " unasked, " << s.wrong_speeds << " wrong speeds, " << s.encoder_jumps << " jumps, " << s.implausible
        << " implausible";
    EXPECT_GT(s.asked_again, 20U);
    EXPECT_GT(s.overdue, 20U);
    EXPECT_LE(youngest, 60 * kMs) << "half of what an answer that came in time may have taken";
    EXPECT_TRUE(rig.body.moves());
  }
}

TEST(EpuckWire, StopsARobotWithin200MsAndDrivesItWithin1sAfterAnOutage) {
  for (const hal::TimeNs outage : {300 * kMs, 1000 * kMs, 3700 * kMs, 20'050 * kMs}) {
    WireRig rig(ticking(50 * kMs));
    auto& wheels = take_all(rig);
    rig.run(500 * kMs);
    const auto drive = [&] { wheels.set(kCruise_m_s, kCruise_m_s); };
    for (int i = 0; i < 20; ++i) rig.tick(50 * kMs, drive);
    ASSERT_TRUE(rig.body.moves());
    rig.to_robot.cut = rig.to_host.cut = true;
    for (const hal::TimeNs end = rig.now + outage; rig.now < end;) rig.tick(50 * kMs, drive);
    EXPECT_TRUE(rig.body.moves()) << "nobody can reach it";
    rig.to_robot.cut = rig.to_host.cut = false;
    const hal::TimeNs back = rig.now;
    hal::TimeNs stopped = 0;
    hal::TimeNs driven = 0;
    rig.each_step = [&] {
      if (stopped == 0 && !rig.body.moves()) stopped = rig.now;
      if (stopped != 0 && driven == 0 && rig.body.moves()) driven = rig.now;
    };
    for (int i = 0; i < 30; ++i) rig.tick(50 * kMs, drive);
    EXPECT_LE(stopped - back, 200 * kMs) << outage / kMs;
    EXPECT_GT(driven, stopped);
    EXPECT_LE(driven - back, 1000 * kMs) << outage / kMs;
  }
}

TEST(EpuckWire, StopsADeafRobotThatIsHeardAgainWithin200Ms) {
  WireRig rig(ticking(50 * kMs));
  auto& wheels = take_all(rig);
  rig.run(500 * kMs);
  const auto drive = [&] { wheels.set(kCruise_m_s, kCruise_m_s); };
  for (int i = 0; i < 20; ++i) rig.tick(50 * kMs, drive);
  rig.to_robot.cut = true;
  for (int i = 0; i < 67; ++i) rig.tick(50 * kMs, drive);
  rig.to_robot.cut = false;
  double slowest_m_s = kCruise_m_s;
  for (int i = 0; i < 4; ++i) {
    rig.tick(50 * kMs, drive);
    slowest_m_s = std::min(slowest_m_s, rig.body.left_m_s);
  }
  EXPECT_GT(rig.driver.session().statistics().handshakes, 1U);
  EXPECT_LT(slowest_m_s, kCruise_m_s) << "it was not stopped";
}

TEST(EpuckWire, IsDrivenWithin1sOfANewLink) {
  WireRig rig(ticking(50 * kMs));
  auto& wheels = take_all(rig);
  rig.run(500 * kMs);
  const auto drive = [&] { wheels.set(kCruise_m_s, kCruise_m_s); };
  for (int i = 0; i < 20; ++i) rig.tick(50 * kMs, drive);
  rig.driver.link_gone(rig.now);
  rig.plug_in();
  const hal::TimeNs back = rig.now;
  hal::TimeNs stopped = 0;
  hal::TimeNs driven = 0;
  rig.each_step = [&] {
    if (stopped == 0 && !rig.body.moves()) stopped = rig.now;
    if (stopped != 0 && driven == 0 && rig.body.moves()) driven = rig.now;
  };
  for (int i = 0; i < 30; ++i) rig.tick(50 * kMs, drive);
  EXPECT_LE(stopped - back, 50 * kMs);
  EXPECT_GT(driven, 0);
  EXPECT_LE(driven - back, 1000 * kMs);
}

// The stop itself under loss, over many seeds. What is left of it must not drive.
TEST(EpuckWire, NeverEndsDrivingAfterAStopWithTenToThirtyPercentOfAllBytesLost) {
  int confirmed = 0;
  for (std::uint64_t seed = 1; seed <= 150; ++seed) {
    WireRig rig(ticking(100 * kMs), seed);
    auto& wheels = take_all(rig);
    rig.run(500 * kMs);
    const auto drive = [&] { wheels.set(kCruise_m_s, -kCruise_m_s); };
    for (int i = 0; i < 5; ++i) rig.tick(100 * kMs, drive);
    ASSERT_TRUE(rig.body.moves());
    rig.to_robot.loss = rig.to_host.loss = 0.1 + 0.1 * static_cast<double>(seed % 3);
    rig.run(static_cast<hal::TimeNs>(seed % 7) * 13 * kMs);
    rig.driver.stop(rig.now);
    rig.run(300 * kMs);
    EXPECT_FALSE(rig.body.moves()) << "seed " << seed;
    bool moved = false;
    rig.each_step = [&] { moved = moved || rig.body.moves(); };
    for (int i = 0; i < 20; ++i) rig.tick(100 * kMs, drive);
    EXPECT_FALSE(moved) << "seed " << seed;
    if (rig.driver.at_rest()) ++confirmed;
    rig.to_robot.loss = rig.to_host.loss = 0.0;
    for (int i = 0; i < 10; ++i) rig.tick(100 * kMs, drive);
    EXPECT_TRUE(rig.driver.at_rest()) << "seed " << seed;
    EXPECT_FALSE(moved) << "seed " << seed;
  }
  EXPECT_GT(confirmed, 0);
}

// One damaged byte of a stop, said to a robot that stands: each of its bytes doubled, and with each of its bits
// flipped.
TEST(EpuckWire, MovesFor15MsAtMostAndIsNotBelievedToRestWhenAByteOfItsStopIsDamaged) {
  hal::TimeNs longest = 0;
  std::size_t in_all = 0;
  for (std::size_t i = 0; i < kStopBursts; ++i) in_all += stop_burst(i).size();
  for (std::size_t damaged = 0; damaged < in_all; ++damaged) {
    for (unsigned bit = 0; bit <= 8; ++bit) {
      WireRig rig;
      rig.run(500 * kMs);
      ASSERT_TRUE(rig.driver.at_rest());
      std::size_t sent = 0;
      rig.to_robot.fault = [&](std::uint8_t byte, hal::TimeNs) -> std::vector<std::uint8_t> {
        if (sent++ != damaged) return {byte};
        if (bit == 8) return {byte, byte};
        return {static_cast<std::uint8_t>(byte ^ (1U << bit))};
      };
      hal::TimeNs moves_since = 0;
      rig.each_step = [&] {
        if (!rig.body.moves()) moves_since = 0;
        if (!rig.body.moves()) return;
        if (moves_since == 0) moves_since = rig.now;
        longest = std::max(longest, rig.now - moves_since);
        EXPECT_FALSE(rig.driver.at_rest()) << "byte " << damaged << ", bit " << bit;
      };
      rig.driver.shut_down(rig.now);
      rig.run(400 * kMs);
      EXPECT_TRUE(rig.driver.at_rest()) << "byte " << damaged << ", bit " << bit;
    }
  }
  EXPECT_GT(longest, 10 * kMs);
  EXPECT_LE(longest, 15 * kMs);
}

// Ordinary driving, bytes lost towards the robot: how long wheels may turn in a way that they were never told to.
TEST(EpuckWire, WrongSpeedsLastNoLongerThanTheBoundThatTheDocsName) {
  hal::TimeNs longest = 0;
  int times = 0;
  for (std::uint64_t seed = 1; seed <= 40; ++seed) {
    WireRig rig(ticking(100 * kMs), seed);
    auto& wheels = take_all(rig);
    rig.run(500 * kMs);
    rig.tick(100 * kMs);
    rig.to_robot.loss = 0.02;
    hal::TimeNs wrong_since = 0;
    rig.each_step = [&] {
      const double fastest = std::max(std::fabs(rig.body.left_m_s), std::fabs(rig.body.right_m_s));
      if (fastest <= 1.1 * kCruise_m_s) {  // the firmware's periods are whole ticks
        wrong_since = 0;
        return;
      }
      if (wrong_since == 0) {
        wrong_since = rig.now;
        ++times;
      }
      longest = std::max(longest, rig.now - wrong_since);
    };
    for (int i = 0; i < 300; ++i) {
      rig.tick(100 * kMs, [&] { wheels.set(i % 2 == 0 ? kCruise_m_s : -kCruise_m_s, 0.5 * kCruise_m_s); });
    }
  }
  EXPECT_GT(times, 20) << "the test must see some";
  EXPECT_LE(longest, 300 * kMs);
}

/// Takes what an e-puck2 alone has.
struct Epuck2Ports {
  explicit Epuck2Ports(EpuckRobot& robot)
      : gyroscope(robot.sensor<hal::Gyroscope>()),
        ahead(robot.sensor<hal::TimeOfFlight>()),
        cliff(robot.sensor<hal::Cliff>()),
        selector(robot.sensor<hal::Selector>()),
        microphones(robot.sensor<hal::Microphones>()) {}
  const hal::Gyroscope& gyroscope;
  const hal::TimeOfFlight& ahead;
  const hal::Cliff& cliff;
  const hal::Selector& selector;
  const hal::Microphones& microphones;
};

TEST(Epuck2OnASerialLine, TellsWhatItAloneHas) {
  WireRig rig({.robot = {.kind = &hal::epuck2::kind(), .tick_ns = 100 * kMs}}, 1, epuck_emulator::Variant::Epuck2);
  const Epuck2Ports ports(rig.driver.robot());
  for (int i = 0; i < 20; ++i) rig.tick(100 * kMs);
  ASSERT_EQ(rig.driver.state(), SessionState::Active) << rig.driver.session().trouble();
  EXPECT_EQ(ports.gyroscope.validity, hal::Validity::Fresh);
  EXPECT_EQ(ports.ahead.validity, hal::Validity::Fresh);
  EXPECT_FLOAT_EQ(ports.ahead.distance_m, 2.0F);
  EXPECT_EQ(ports.selector.validity, hal::Validity::Fresh);
  EXPECT_EQ(ports.selector.position, 3U);
  EXPECT_EQ(ports.cliff.validity, hal::Validity::Fresh);
  EXPECT_EQ(ports.cliff.count, 1U) << "the right one";
  EXPECT_EQ(ports.microphones.count, 4U);
  EXPECT_EQ(rig.driver.robot().untold(rig.driver.session().layout(), rig.driver.session().samples()), "");
  EXPECT_EQ(rig.driver.session().statistics().handshake_failures, 0U);
}

TEST(Epuck2OnASerialLine, IsToldFromAnEpuckThatTheFileCallsSo) {
  WireRig rig({.robot = {.kind = &hal::epuck2::kind(), .tick_ns = 100 * kMs}}, 1, epuck_emulator::Variant::Btcom);
  const Epuck2Ports ports(rig.driver.robot());
  for (int i = 0; i < 20; ++i) rig.tick(100 * kMs);
  ASSERT_EQ(rig.driver.state(), SessionState::Active) << rig.driver.session().trouble();
  EXPECT_EQ(ports.gyroscope.validity, hal::Validity::Absent);
  EXPECT_EQ(ports.ahead.validity, hal::Validity::Absent);
  EXPECT_EQ(ports.selector.validity, hal::Validity::Absent);
  EXPECT_EQ(ports.cliff.validity, hal::Validity::Absent);
  EXPECT_EQ(ports.microphones.count, 3U);
  EXPECT_EQ(rig.driver.robot().untold(rig.driver.session().layout(), rig.driver.session().samples()),
            "gyroscope, time_of_flight, cliff, selector");
}

// The firmwares answer zeros where the board or the chip is missing: no black floor, and no robot that does not turn.
TEST(EpuckOnASerialLine, WithoutAFloorBoardHasNoGroundReadings) {
  for (const auto variant :
       {epuck_emulator::Variant::Btcom, epuck_emulator::Variant::Gctronic, epuck_emulator::Variant::Epuck2}) {
    WireRig bare({.robot = {.tick_ns = 100 * kMs}}, 1, {.variant = variant, .ground_board = false});
    WireRig fitted({.robot = {.tick_ns = 100 * kMs}}, 1, {.variant = variant});
    const auto& none = bare.driver.robot().sensor<hal::Ground>();
    const auto& some = fitted.driver.robot().sensor<hal::Ground>();
    for (int i = 0; i < 50; ++i) {
      bare.tick(100 * kMs);
      fitted.tick(100 * kMs);
      ASSERT_EQ(none.validity, hal::Validity::Absent) << i;
    }
    ASSERT_EQ(bare.driver.state(), SessionState::Active) << bare.driver.session().trouble();
    EXPECT_EQ(some.validity, hal::Validity::Fresh);
    EXPECT_FLOAT_EQ(some.reflectance[1], 1.0F);
    EXPECT_EQ(bare.driver.robot().untold(bare.driver.session().layout(), bare.driver.session().samples()), "ground");
  }
}

TEST(EpuckOnASerialLine, OfHardwareBefore13HasNoGyroscopeWhateverTheFileCallsIt) {
  WireRig rig({.robot = {.kind = &hal::epuck2::kind(), .tick_ns = 100 * kMs}}, 1, epuck_emulator::Variant::Gctronic);
  const auto& gyroscope = rig.driver.robot().sensor<hal::Gyroscope>();
  for (int i = 0; i < 50; ++i) {
    rig.tick(100 * kMs);
    ASSERT_EQ(gyroscope.validity, hal::Validity::Absent) << i;
  }
  ASSERT_EQ(rig.driver.state(), SessionState::Active) << rig.driver.session().trouble();
  EXPECT_EQ(rig.driver.robot().untold(rig.driver.session().layout(), rig.driver.session().samples()), "gyroscope");
}

TEST(Epuck, HasNothingOfAnEpuck2AndSaysWhoHas) {
  EpuckRobot robot({.id = "ep0"});
  try {
    robot.sensor<hal::TimeOfFlight>();
    FAIL() << "it has none";
  } catch (const hal::DeviceError& e) {
    EXPECT_STREQ(e.what(), "e-puck 'ep0' has no sensor 'time_of_flight'; an <e-puck2> has one");
  }
}

}  // namespace
}  // namespace tandem::bridges::epuck
