#include "bridges/epuck_emulator/body.hpp"

#include <cmath>
#include <gtest/gtest.h>
#include <thread>

#include "bridges/epuck_emulator/raw_units.hpp"
#include "bridges/epuck_emulator/stepper.hpp"
#include "hal/device/leds.hpp"
#include "hal/device/ring_sensors.hpp"
#include "hal/device/wheels.hpp"

namespace tandem::bridges::epuck_emulator {
namespace {

using hal::TimeNs;
constexpr TimeNs kSecond = hal::kNsPerSecond;
constexpr TimeNs kTick = 100'000;

TEST(Stepper, CountsWhatItWasToldExactlyHoweverLong) {
  Stepper motor(1000, kTick);
  motor.set_speed(1000, 5);
  motor.advance(5 + 86400 * kSecond);
  EXPECT_EQ(motor.count(), 86'400'000);
  motor.set_speed(-500, 5 + 86400 * kSecond);
  motor.advance(5 + 86401 * kSecond);
  EXPECT_EQ(motor.count(), 86'399'500);
}

TEST(Stepper, CountsTheSameInManyLooksAsInOne) {
  Stepper often(1000, kTick);
  Stepper once(1000, kTick);
  often.set_speed(333, 0);
  once.set_speed(333, 0);
  for (TimeNs t = 0; t <= kSecond; t += 777'777) often.advance(t);
  often.advance(kSecond);
  once.advance(kSecond);
  EXPECT_EQ(often.count(), once.count());
}

TEST(Stepper, RoundsThePeriodOfVersionOne) {
  const auto real = [](int commanded) {
    Stepper motor(1000, kTick);
    motor.set_speed(commanded, 0);
    return motor.real_steps_s();
  };
  EXPECT_NEAR(real(900), 909.1, 0.1);
  EXPECT_NEAR(real(700), 714.3, 0.1);
  EXPECT_NEAR(real(600), 625.0, 0.1);
  EXPECT_NEAR(real(-600), -625.0, 0.1);
  EXPECT_NEAR(real(1000), 1000.0, 1e-9);
  EXPECT_NEAR(real(30000), 1000.0, 1e-9);
  EXPECT_NEAR(real(1), 1.0, 1e-9);
  EXPECT_EQ(real(0), 0.0);
  Stepper two(1100, 0);
  two.set_speed(900, 0);
  EXPECT_NEAR(two.real_steps_s(), 900.0, 1e-3);
}

TEST(KinematicBody, DrivesACircle) {
  KinematicBody body;
  body.actuate(0, {.left_m_s = 0.05, .right_m_s = 0.1});
  const double turn_rad_s = 0.05 / hal::epuck::kind().drive()->wheel_base_m;
  const double radius_m = 0.075 / turn_rad_s;
  body.advance(kSecond);
  EXPECT_NEAR(body.pose().x_m, radius_m * std::sin(turn_rad_s), 1e-12);
  EXPECT_NEAR(body.pose().y_m, radius_m * (1.0 - std::cos(turn_rad_s)), 1e-12);
  EXPECT_NEAR(body.pose().heading_rad, turn_rad_s, 1e-12);
  EXPECT_NEAR(body.sense(kSecond).turn_rad_s[2], turn_rad_s, 1e-12);
}

TEST(KinematicBody, StandsStillUntilAskedWhateverTheClockSays) {
  KinematicBody body;
  body.advance(1000 * kSecond);
  body.actuate(2000 * kSecond, {.left_m_s = 0.1, .right_m_s = 0.1});
  body.advance(2001 * kSecond);
  EXPECT_NEAR(body.pose().x_m, 0.1, 1e-12);
}

TEST(KinematicBody, SeesAndIsStoppedByWalls) {
  KinematicBody body({}, Arena{.length_x_m = 0.5, .length_y_m = 0.5});
  EXPECT_EQ(body.sense(0).distance_m[0], hal::epuck::kind().part<hal::ProximityPart>()->range_m);
  body.actuate(0, {.left_m_s = 0.1, .right_m_s = 0.1});
  const BodySenses senses = body.sense(10 * kSecond);
  EXPECT_NEAR(body.pose().x_m, 0.25 - hal::epuck::kind().body.radius_m, 1e-12);
  // ps0 looks 17 degrees off the axis from a rim that touches the wall.
  const double c = std::cos(17.0 * std::numbers::pi / 180.0);
  EXPECT_NEAR(senses.distance_m[0], hal::epuck::kind().body.radius_m * (1.0 - c) / c, 1e-9);
  EXPECT_NEAR(senses.distance_m[7], senses.distance_m[0], 1e-12);
  EXPECT_EQ(senses.distance_m[3], hal::epuck::kind().part<hal::ProximityPart>()->range_m);
  EXPECT_NEAR(senses.ahead_m, 0.0, 1e-9);
}

TEST(PortBody, PassesBothWaysBetweenThreads) {
  SharedPorts ports(body_ports());
  std::thread robot([&ports] {
    PortBody body(ports);
    for (int i = 1; i <= 1000; ++i) {
      body.actuate(i, {.told_left_m_s = i * 0.001, .told_right_m_s = i * 0.001});
      const BodySenses s = body.sense(i);
      EXPECT_EQ(s.distance_m[0], s.distance_m[7]) << "torn";
    }
  });
  for (int i = 0; i < 1000; ++i) {
    ports.tell([i](const PortBank& bank) {
      auto& proximity = bank.port<hal::Proximity>();
      proximity.validity = hal::Validity::Fresh;
      proximity.distance_m.fill(static_cast<float>(i) * 1e-4F);
    });
    ports.with([](const PortBank& bank) {
      const auto& wheels = bank.port<hal::WheelSpeeds>();
      EXPECT_EQ(wheels.left_m_s, wheels.right_m_s) << "torn";
    });
  }
  robot.join();
  ports.with([](const PortBank& bank) { EXPECT_EQ(bank.port<hal::WheelSpeeds>().left_m_s, 1.0); });
}

TEST(PortBody, IsOnOpenGroundAsLongAsNothingIsTold) {
  SharedPorts ports(body_ports());
  PortBody body(ports);
  EXPECT_EQ(body.sense(0).distance_m, BodySenses{}.distance_m);
  EXPECT_EQ(body.sense(0).battery_V, BodySenses{}.battery_V);
  body.actuate(0, {.ring = 0b101, .body_led = true});
  ports.with([](const PortBank& bank) {
    EXPECT_EQ(bank.port<hal::RingLeds>().color(0), hal::kRed);
    EXPECT_EQ(bank.port<hal::RingLeds>().color(1), hal::kBlack);
    EXPECT_TRUE(bank.port<hal::BodyLed>().on);
  });
}

TEST(RawUnits, FollowTheInfraredCurveAndFallWithDistance) {
  for (const hal::InfraredResponse& knot : hal::epuck::kind().part<hal::ProximityPart>()->response) {
    EXPECT_NEAR(proximity_counts(knot.distance_m), knot.counts, 0.5);
  }
  for (double d = 0.0; d < 0.12; d += 0.0005) EXPECT_GE(proximity_counts(d), proximity_counts(d + 0.0005));
  EXPECT_EQ(proximity_counts(-1.0), 4095);
  EXPECT_EQ(proximity_counts(1.0), 0);
}

TEST(RawUnits, StayInTheConvertersRangeForAnyInput) {
  for (const double wild : {-1e300, -1.0, 2.0, 1e300, std::nan(""), HUGE_VAL}) {
    for (const int counts : {ambient_counts(wild), ground_counts(wild), microphone_counts(wild), battery_counts(wild),
                             battery_counts_epuck2(wild), proximity_counts(wild)}) {
      EXPECT_GE(counts, 0);
      EXPECT_LE(counts, 4095);
    }
    EXPECT_LE(std::abs(gyro_counts(wild)), 32768);
    EXPECT_LE(std::abs(acceleration_counts(wild)), 4095);
  }
}

}  // namespace
}  // namespace tandem::bridges::epuck_emulator
