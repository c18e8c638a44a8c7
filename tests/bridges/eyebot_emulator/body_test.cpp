// A body of its own, against closed forms.
#include "bridges/eyebot_emulator/body.hpp"

#include <cmath>
#include <gtest/gtest.h>

#include "bridges/eyebot_emulator/battery.hpp"
#include "bridges/eyebot_emulator/point_body.hpp"
#include "hal/device/flight.hpp"
#include "hal/device/range_and_bearing.hpp"
#include "hal/device/ring_sensors.hpp"

namespace tandem::bridges::eyebot_emulator {
namespace {

namespace spec = hal::eyebot;
constexpr hal::TimeNs kSecond = hal::kNsPerSecond;
constexpr double kPi = std::numbers::pi;

BodyCommand flying(double x, double y, double z, double yaw_rate = 0.0) {
  BodyCommand c;
  c.motors = true;
  c.velocity_m_s = {x, y, z};
  c.yaw_rad_s = yaw_rate;
  return c;
}

TEST(PointBody, StandsWithoutMotors) {
  PointBody body;
  const BodySenses s = body.sense(0);
  EXPECT_TRUE(s.on_ground);
  EXPECT_EQ(body.sense(10 * kSecond).p_WB, (Vec3{}));
  EXPECT_EQ(body.sense(10 * kSecond).ground_m, 0.0);
  EXPECT_LT(body.sense(10 * kSecond).ceiling_m, 0.0) << "no room, no echo";
}

TEST(PointBody, ReachesASpeedWithTheGreatestAcceleration) {
  PointBody body(Start{{0.0, 0.0, 5.0}, 0.0});
  body.actuate(0, flying(1.2, 0.0, 0.0));
  const double ramp_s = 1.2 / spec::kind().flight()->max_acceleration_m_s2;
  body.advance(static_cast<hal::TimeNs>(ramp_s * 1e9));
  EXPECT_NEAR(body.sense(static_cast<hal::TimeNs>(ramp_s * 1e9)).p_WB[0], 0.5 * 1.2 * ramp_s, 1e-8);
  const BodySenses s = body.sense(2 * kSecond);
  EXPECT_NEAR(s.v_WB[0], 1.2, 1e-12);
  EXPECT_NEAR(s.p_WB[0], 0.5 * 1.2 * ramp_s + 1.2 * (2.0 - ramp_s), 1e-9);
  EXPECT_NEAR(s.p_WB[2], 5.0, 1e-12);
}

TEST(PointBody, LeansAsItAccelerates) {
  PointBody body(Start{{0.0, 0.0, 5.0}, kPi / 2.0});
  body.actuate(0, flying(0.0, 2.0, 0.0));  // forward, as it looks along y
  const BodySenses s = body.sense(kSecond / 10);
  const auto [w, x, y, z] = s.q_WB;
  EXPECT_NEAR(w * w + x * x + y * y + z * z, 1.0, 1e-12);
  // The body's z axis in W points along gravity and acceleration.
  EXPECT_NEAR(2.0 * (x * z + w * y), 0.0, 1e-9);
  EXPECT_NEAR(2.0 * (y * z - w * x) / (1.0 - 2.0 * (x * x + y * y)),
              spec::kind().flight()->max_acceleration_m_s2 / 9.81, 1e-9);
  EXPECT_NEAR(s.yaw_rad(), kPi / 2.0, 1e-9);
}

TEST(PointBody, Turns) {
  PointBody body(Start{{0.0, 0.0, 1.0}, 0.0});
  body.actuate(0, flying(0.0, 0.0, 0.0, 0.5));
  EXPECT_NEAR(body.sense(2 * kSecond).yaw_rad(), 1.0, 1e-9);
  EXPECT_EQ(body.sense(2 * kSecond).turn_rad_s[2], 0.5);
  EXPECT_NEAR(body.sense(8 * kSecond).yaw_rad(), 4.0 - 2.0 * kPi, 1e-9);
}

TEST(PointBody, FallsWithoutMotors) {
  PointBody body(Start{{0.0, 0.0, 2.0}, 0.0});
  body.actuate(0, flying(0.0, 0.0, 0.0));
  body.actuate(kSecond, BodyCommand{});
  EXPECT_NEAR(body.sense(kSecond + kSecond / 2).p_WB[2], 2.0 - 0.5 * 9.81 * 0.25, 1e-9);
  const BodySenses s = body.sense(3 * kSecond);
  EXPECT_TRUE(s.on_ground);
  EXPECT_EQ(s.v_WB, (Vec3{}));
  EXPECT_NEAR(body.touched_m_s(), std::sqrt(2.0 * 9.81 * 2.0), 0.1);
}

TEST(PointBody, IsStoppedByWallsCeilingAndGround) {
  PointBody body(Start{{0.0, 0.0, 1.0}, 0.0}, Room{4.0, 6.0, 3.0});
  body.actuate(0, flying(2.0, 2.0, 2.0));
  BodySenses s = body.sense(20 * kSecond);
  EXPECT_NEAR(s.p_WB[0], 2.0 - spec::kind().body.radius_m, 1e-12);
  EXPECT_NEAR(s.p_WB[1], 3.0 - spec::kind().body.radius_m, 1e-12);
  EXPECT_NEAR(s.p_WB[2], 3.0 - spec::kind().body.height_m, 1e-12);
  EXPECT_NEAR(s.ceiling_m, 0.0, 1e-12);
  EXPECT_FALSE(s.at_ceiling) << "without its magnet";
  body.actuate(20 * kSecond, flying(0.0, 0.0, -1.0));
  s = body.sense(30 * kSecond);
  EXPECT_TRUE(s.on_ground);
  EXPECT_NEAR(s.ceiling_m, 3.0 - spec::kind().body.height_m, 1e-12);
}

TEST(PointBody, HangsOnItsMagnet) {
  PointBody body(Start{{0.0, 0.0, 1.0}, 0.0}, Room{4.0, 4.0, 3.0});
  BodyCommand c = flying(0.0, 0.0, 1.0);
  c.magnet = true;
  body.actuate(0, c);
  EXPECT_TRUE(body.sense(5 * kSecond).at_ceiling);
  c.motors = false;
  body.actuate(5 * kSecond, c);
  EXPECT_TRUE(body.sense(60 * kSecond).at_ceiling);
  EXPECT_NEAR(body.sense(60 * kSecond).p_WB[2], 3.0 - spec::kind().body.height_m, 1e-12);
  c.magnet = false;
  body.actuate(60 * kSecond, c);
  EXPECT_TRUE(body.sense(62 * kSecond).on_ground);
}

TEST(PointBody, SeesTheWallsAllAround) {
  PointBody body(Start{{0.5, 0.0, 1.0}, 0.0}, Room{4.0, 40.0, 3.0});
  BodyCommand c = flying(0.0, 0.0, 0.0);
  c.scanner = ScannerMode::Speed;
  c.scanner_rad_s = kPi / 2.0;
  body.actuate(0, c);
  BodySenses s = body.sense(0);
  EXPECT_NEAR(s.scan_m[0], 1.5, 1e-12);
  EXPECT_NEAR(s.scan_m[2], 2.5, 1e-12);
  EXPECT_NEAR(s.distance_m[0], 1.5 / std::cos(7.5 * kPi / 180.0) - 0.255, 1e-9);
  EXPECT_EQ(s.distance_m[6], spec::kind().part<hal::ProximityPart>()->range_m);
  s = body.sense(kSecond);  // a quarter turn later the heads have changed places
  EXPECT_NEAR(s.scan_m[3], 1.5, 1e-9);
  EXPECT_NEAR(s.scan_m[1], 2.5, 1e-9);
  c.scanner = ScannerMode::Off;
  body.actuate(kSecond, c);
  EXPECT_TRUE(std::isinf(body.sense(kSecond).scan_m[0]));
}

TEST(PointBody, TurnsItsHeadInTime) {
  PointBody body;
  BodyCommand c;
  c.pan_rad = -3.0;
  c.tilt_rad = 9.0;  // farther than it can
  body.actuate(0, c);
  EXPECT_NEAR(body.sense(kSecond / 10).pan_rad, -0.1 * kPi, 1e-9);
  EXPECT_NEAR(body.sense(2 * kSecond).pan_rad, -3.0, 1e-9);
  EXPECT_NEAR(body.sense(2 * kSecond).tilt_rad, kPi / 2.0, 1e-9);
}

TEST(PointBody, IsTheSameHoweverOftenItIsLookedAt) {
  PointBody rarely(Start{{0.0, 0.0, 1.0}, 0.0}, Room{});
  PointBody often(Start{{0.0, 0.0, 1.0}, 0.0}, Room{});
  for (PointBody* body : {&rarely, &often}) body->actuate(0, flying(1.0, -0.5, 0.3, 0.7));
  for (hal::TimeNs t = 0; t <= 5 * kSecond; t += 10 * hal::kNsPerMs) often.advance(t);
  EXPECT_EQ(rarely.sense(5 * kSecond).p_WB, often.sense(5 * kSecond).p_WB);
  EXPECT_EQ(rarely.sense(5 * kSecond).q_WB, often.sense(5 * kSecond).q_WB);
}

TEST(PortBody, CarriesBothWays) {
  SharedPorts ports(body_ports());
  PortBody body(ports);
  EXPECT_TRUE(body.take_heard().empty());
  ports.tell([](const PortBank& bank) {
    auto& place = bank.port<hal::Positioning>();
    place.validity = hal::Validity::Fresh;
    place.p_WB = {1.0, 2.0, 3.0};
    bank.port<hal::FlightState>().phase = hal::FlightPhase::Hovering;
    const std::uint8_t byte = 9;
    bank.port<hal::RangeAndBearing>().insert(1.0F, 0.0F, 0.0F, &byte, 1);
  });
  EXPECT_EQ(body.sense(0).p_WB, (Vec3{1.0, 2.0, 3.0}));
  ASSERT_EQ(body.take_heard().size(), 1U);
  EXPECT_TRUE(body.take_heard().empty()) << "nothing was told since";
  BodyCommand command = flying(1.0, 0.0, 0.0);
  command.manoeuvre = Manoeuvre::TakeOff;
  body.actuate(0, command);
  ports.with([](const PortBank& bank) {
    EXPECT_EQ(bank.port<hal::QuadrotorSpeed>().velocity[0], 1.0);
    EXPECT_EQ(bank.port<hal::FlightTask>().order, hal::FlightOrder::Fly) << "it is through with taking off";
  });
  command.motors = false;
  body.actuate(0, command);
  ports.with([](const PortBank& bank) { EXPECT_EQ(bank.port<hal::QuadrotorSpeed>().velocity[0], 0.0); });
}

TEST(Battery, RunsDownFasterInFlight) {
  EmulatedBattery battery(100.0);
  battery.run(10 * kSecond, true);
  EXPECT_NEAR(battery.charge(), 0.9, 1e-12);
  EXPECT_NEAR(battery.time_left_s(true), 90.0, 1e-9);
  battery.run(200 * kSecond, false);
  EXPECT_NEAR(battery.charge(), 0.8, 1e-12);
  battery.run(1000 * kSecond, true);
  EXPECT_EQ(battery.charge(), 0.0);
}

}  // namespace
}  // namespace tandem::bridges::eyebot_emulator
