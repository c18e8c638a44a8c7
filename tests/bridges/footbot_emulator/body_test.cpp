#include <cmath>
#include <gtest/gtest.h>

#include "bridges/footbot_emulator/kinematic_body.hpp"
#include "bridges/footbot_emulator/raw_units.hpp"
#include "hal/device/ring_sensors.hpp"

namespace tandem::bridges::footbot_emulator {
namespace {

constexpr hal::TimeNs kSecond = hal::kNsPerSecond;

TEST(KinematicBody, TurnsInACircle) {
  KinematicBody body;
  BodyCommand command;
  command.left_m_s = 0.05;
  command.right_m_s = 0.15;
  body.actuate(0, command);
  body.advance(2 * kSecond);
  // 0.1 m/s along, 1/1.4 rad/s around a centre 0.14 m to the left.
  const double turn = 2 * 0.1 / hal::footbot::kind().drive()->wheel_base_m;
  const double radius = 0.14;
  EXPECT_NEAR(body.pose().x_m, radius * std::sin(turn), 1e-9);
  EXPECT_NEAR(body.pose().y_m, radius * (1 - std::cos(turn)), 1e-9);
  EXPECT_NEAR(body.pose().heading_rad, turn, 1e-9);
}

TEST(KinematicBody, IsStoppedByWallsAndSeesThem) {
  KinematicBody body({0.0, 0.0, 0.0}, Arena{1.0, 2.0});
  BodyCommand command;
  command.left_m_s = command.right_m_s = 0.2;
  body.actuate(0, command);
  const BodySenses senses = body.sense(10 * kSecond);
  EXPECT_DOUBLE_EQ(body.pose().x_m, 0.5 - hal::footbot::kind().body.radius_m);
  // The sensor at 7.5 degrees sits on the rim and looks along its radius.
  const double c = std::cos(7.5 * M_PI / 180);
  EXPECT_NEAR(senses.distance_m[0], hal::footbot::kind().body.radius_m * (1 - c) / c, 1e-9);
  EXPECT_DOUBLE_EQ(senses.distance_m[12], hal::footbot::kind().part<hal::ProximityPart>()->range_m);
}

TEST(KinematicBody, MeasuresNothingWhileItsScannerIsOff) {
  KinematicBody body({}, Arena{1.0, 1.0});
  EXPECT_TRUE(std::isinf(body.sense(0).scan_m[0]));
  BodyCommand command;
  command.scanner = ScannerMode::Speed;
  command.scanner_rad_s = M_PI / 2;
  body.actuate(0, command);
  EXPECT_NEAR(body.sense(0).scan_m[0], 0.5, 1e-9);
  EXPECT_NEAR(body.sense(kSecond / 2).scan_m[0], 0.5 * std::sqrt(2.0), 1e-6);
  EXPECT_NEAR(body.sense(kSecond / 2).scanner_rad, M_PI / 4, 1e-9);
}

TEST(KinematicBody, TurnsItsTurretTheShorterWay) {
  KinematicBody body;
  BodyCommand command;
  command.turret = TurretMode::Position;
  command.turret_rad = -3.0;
  body.actuate(0, command);
  EXPECT_LT(body.sense(kSecond / 2).turret_rad, 0.0);
  EXPECT_NEAR(body.sense(5 * kSecond).turret_rad, -3.0, 1e-9);
  command.turret_rad = 3.0;
  body.actuate(5 * kSecond, command);
  EXPECT_NEAR(body.sense(6 * kSecond).turret_rad, 3.0, 1e-9);
}

TEST(RawUnits, AreTheRobots) {
  EXPECT_NEAR(wheel_m_s(72), 0.298, 0.001);
  EXPECT_EQ(proximity_raw(0.1), 0);
  EXPECT_EQ(proximity_raw(0.0), 4096);
  EXPECT_EQ(proximity_raw(0.05), 2048);
  EXPECT_EQ(proximity_raw(std::nan("")), 0);
  EXPECT_EQ(scan_raw(0.03, 0.04, 0.3), -1);
  EXPECT_EQ(scan_raw(0.104, 0.04, 0.3), 10);
  EXPECT_EQ(scan_raw(0.3, 0.04, 0.3), -2);
  EXPECT_EQ(scan_raw(std::nan(""), 0.04, 0.3), -2);
  EXPECT_EQ(angle_raw(M_PI / 2), 16384);
  EXPECT_EQ(angle_raw(-M_PI / 2), -16384);
  EXPECT_EQ(angle_raw(M_PI), -32768);
  EXPECT_EQ(angle_raw(2 * M_PI), 0);
  EXPECT_NEAR(angle_rad(-16384), -M_PI / 2, 1e-12);
  EXPECT_NEAR(turret_rad_s(4), M_PI / 2, 1e-12);
  EXPECT_NEAR(turret_rad_s(-9), -M_PI / 2, 1e-12);
  EXPECT_NEAR(scanner_rad_s(30), M_PI, 1e-12);
  EXPECT_EQ(motor_ground_raw(0.5), 512);
  EXPECT_EQ(thousandths_raw(99.0), 32767);
}

}  // namespace
}  // namespace tandem::bridges::footbot_emulator
