#include "hal/limits.hpp"

#include <cmath>
#include <gtest/gtest.h>
#include <limits>
#include <rapidcheck.h>

#include "hal/device/distance_scanner.hpp"
#include "hal/device/flight.hpp"
#include "hal/device/gripper.hpp"
#include "hal/device/leds.hpp"
#include "hal/device/pan_tilt.hpp"
#include "hal/device/turret.hpp"
#include "hal/device/wheels.hpp"

namespace tandem::hal {
namespace {

// Each command against a robot with the limits that a test names.
LimitResult limit(WheelSpeeds& command, double most_m_s) {
  return command.limit({.max_speed_m_s = most_m_s}).result;
}
LimitResult limit(QuadrotorSpeed& command, double most_m_s, double most_rad_s) {
  return command.limit({.max_speed_m_s = most_m_s, .max_turn_rad_s = most_rad_s}).result;
}
LimitResult limit(QuadrotorPosition& command) {
  return command.limit({}).result;
}
LimitResult limit(QuadrotorAttitude& command, double most_lean_rad, double most_turn_rad_s, double most_thrust) {
  return command.limit({.max_turn_rad_s = most_turn_rad_s, .max_lean_rad = most_lean_rad, .max_thrust = most_thrust})
      .result;
}
LimitResult limit(FlightTask& command, double most_m_s) {
  return command.limit({.max_speed_m_s = most_m_s}).result;
}
LimitResult limit(PanTiltDrive& command, double most_tilt_rad) {
  return command.limit({.max_tilt_rad = most_tilt_rad}).result;
}
LimitResult limit(GripperDrive& command) {
  return command.limit({}).result;
}
LimitResult limit(TurretDrive& command, double most_rad_s) {
  return command.limit({.turn_rad_s = most_rad_s}).result;
}
LimitResult limit(ScannerDrive& command, double most_rad_s) {
  return command.limit({.turn_rad_s = most_rad_s}).result;
}

WheelSpeeds speeds(double left, double right) {
  WheelSpeeds w;
  w.set(left, right);
  return w;
}

TEST(Limits, PassesWhatIsWithinTheLimit) {
  WheelSpeeds w = speeds(0.1, -0.05);
  EXPECT_EQ(limit(w, 0.1), LimitResult::Passed);
  EXPECT_EQ(w.left_m_s, 0.1);
  EXPECT_EQ(w.right_m_s, -0.05);
}

TEST(Limits, ClampsBothWheelsByTheSameFactor) {
  WheelSpeeds w = speeds(-0.4, 0.2);
  EXPECT_EQ(limit(w, 0.1), LimitResult::Clamped);
  EXPECT_DOUBLE_EQ(w.left_m_s, -0.1);
  EXPECT_DOUBLE_EQ(w.right_m_s, 0.05);
}

TEST(Limits, StopsWhatIsNotFinite) {
  constexpr double kNan = std::numeric_limits<double>::quiet_NaN();
  constexpr double kInf = std::numeric_limits<double>::infinity();
  for (WheelSpeeds w :
       {speeds(kNan, 0.0), speeds(0.0, kNan), speeds(kInf, 0.0), speeds(0.01, -kInf), speeds(kNan, kInf)}) {
    EXPECT_EQ(limit(w, 0.1), LimitResult::NotFinite);
    EXPECT_EQ(w.left_m_s, 0.0);
    EXPECT_EQ(w.right_m_s, 0.0);
  }
}

TEST(Limits, NeverLeavesMoreThanTheLimitAndKeepsTheCurve) {
  EXPECT_TRUE(rc::check([](double left, double right) {
    WheelSpeeds w = speeds(left, right);
    const LimitResult result = limit(w, 0.128);
    RC_ASSERT(std::fabs(w.left_m_s) <= 0.128 * (1.0 + 1e-15));
    RC_ASSERT(std::fabs(w.right_m_s) <= 0.128 * (1.0 + 1e-15));
    if (result == LimitResult::Passed) RC_ASSERT(w.left_m_s == left && w.right_m_s == right);
    if (result == LimitResult::Clamped && std::fabs(left) > 1e-200 && std::fabs(right) > 1e-200) {
      const double before = left / right;
      if (std::isnormal(before) && std::fabs(w.right_m_s) > 1e-200)
        RC_ASSERT(std::fabs(w.left_m_s / w.right_m_s - before) <= 1e-12 * std::fabs(before));
    }
  }));
}

TEST(Limits, ALimitOfZeroStops) {
  WheelSpeeds w = speeds(0.1, 0.1);
  EXPECT_EQ(limit(w, 0.0), LimitResult::Clamped);
  EXPECT_EQ(w.left_m_s, 0.0);
}

QuadrotorSpeed flight(double x, double y, double z, double turn) {
  QuadrotorSpeed f;
  f.set(x, y, z, turn);
  return f;
}

TEST(FlightLimits, PassesWhatIsWithinTheLimits) {
  QuadrotorSpeed f = flight(1.0, -1.0, 0.5, 0.7);
  EXPECT_EQ(limit(f, 1.5, 0.7), LimitResult::Passed);
  EXPECT_EQ(f.velocity, (std::array<double, 3>{1.0, -1.0, 0.5}));
  EXPECT_EQ(f.yaw_rad_s, 0.7);
}

TEST(FlightLimits, KeepsTheDirectionOfWhatIsTooFast) {
  QuadrotorSpeed f = flight(3.0, 0.0, -4.0, -9.0);
  EXPECT_EQ(limit(f, 2.0, 1.5), LimitResult::Clamped);
  EXPECT_DOUBLE_EQ(f.velocity[0], 1.2);
  EXPECT_EQ(f.velocity[1], 0.0);
  EXPECT_DOUBLE_EQ(f.velocity[2], -1.6);
  EXPECT_EQ(f.yaw_rad_s, -1.5);
  QuadrotorSpeed turns = flight(0.1, 0.2, 0.3, 9.0);
  EXPECT_EQ(limit(turns, 2.0, 1.5), LimitResult::Clamped);
  EXPECT_EQ(turns.velocity, (std::array<double, 3>{0.1, 0.2, 0.3}));
  EXPECT_EQ(turns.yaw_rad_s, 1.5);
}

TEST(FlightLimits, NeverLeavesMoreThanTheLimits) {
  EXPECT_TRUE(rc::check([](double x, double y, double z, double turn) {
    QuadrotorSpeed f = flight(x, y, z, turn);
    limit(f, 2.0, 1.5);
    RC_ASSERT(std::hypot(f.velocity[0], f.velocity[1], f.velocity[2]) <= 2.0 * (1.0 + 1e-15));
    RC_ASSERT(std::fabs(f.yaw_rad_s) <= 1.5);
  }));
  QuadrotorSpeed f = flight(1e308, 1e308, -1e308, 1e308);  // its length is no number
  EXPECT_EQ(limit(f, 3.0, 1.5), LimitResult::Clamped);
  EXPECT_NEAR(f.velocity[2], -std::sqrt(3.0), 1e-12);
}

TEST(FlightLimits, HoversWhereACommandIsNotFinite) {
  constexpr double kNan = std::numeric_limits<double>::quiet_NaN();
  constexpr double kInf = std::numeric_limits<double>::infinity();
  for (QuadrotorSpeed f :
       {flight(kNan, 0, 0, 0), flight(0, kInf, 0, 0), flight(1, 0, -kInf, 0), flight(1, 1, 1, kNan)}) {
    EXPECT_EQ(limit(f, 2.0, 1.5), LimitResult::NotFinite);
    EXPECT_EQ(f.velocity, (std::array<double, 3>{}));
    EXPECT_EQ(f.yaw_rad_s, 0.0);
  }
  QuadrotorPosition p;
  p.set(1, 2, 3, 0.4);
  EXPECT_EQ(limit(p), LimitResult::Passed);
  EXPECT_FALSE(p.hold);
  EXPECT_EQ(p.target[2], 3.0);
  for (const std::size_t bad : {0U, 1U, 2U, 3U}) {
    p.set(1, 2, 3, 0.4);
    (bad < 3 ? p.target[bad] : p.yaw_rad) = bad % 2 == 0 ? kNan : kInf;
    EXPECT_EQ(limit(p), LimitResult::NotFinite) << bad;
    EXPECT_TRUE(p.hold);
    EXPECT_EQ(p.target[0], 0.0);
  }
}

template <class Drive>
class TurnLimits : public testing::Test {};
using TurnDrives = testing::Types<TurretDrive, ScannerDrive>;
TYPED_TEST_SUITE(TurnLimits, TurnDrives);

TYPED_TEST(TurnLimits, ClampsSpeedsAndStopsWhatIsNotFinite) {
  constexpr double kNan = std::numeric_limits<double>::quiet_NaN();
  TypeParam drive;
  drive.turn(1.0);
  EXPECT_EQ(limit(drive, 1.0), LimitResult::Passed);
  drive.turn(-3.0);
  EXPECT_EQ(limit(drive, 1.0), LimitResult::Clamped);
  EXPECT_EQ(drive.speed_rad_s, -1.0);
  drive.turn(kNan);
  EXPECT_EQ(limit(drive, 1.0), LimitResult::NotFinite);
  EXPECT_EQ(drive.mode, decltype(drive.mode){}) << "off";
  drive.go_to(kNan);
  EXPECT_EQ(limit(drive, 1.0), LimitResult::NotFinite);
  EXPECT_EQ(drive.angle_rad, 0.0);
  drive.mode = static_cast<decltype(drive.mode)>(17);
  EXPECT_EQ(limit(drive, 1.0), LimitResult::NotFinite) << "a mode that there is not";
  EXPECT_EQ(drive.mode, decltype(drive.mode){});
}

TEST(GripperLimits, ClampsTheApertureAndLetsGoWhenItIsNotFinite) {
  GripperDrive drive;
  drive.lock();
  EXPECT_TRUE(drive.locks());
  EXPECT_EQ(limit(drive), LimitResult::Passed);
  drive.aperture_rad = -2.0;
  EXPECT_EQ(limit(drive), LimitResult::Clamped);
  EXPECT_EQ(drive.aperture_rad, -GripperDrive::kMost_rad);
  EXPECT_TRUE(drive.locks());
  drive.aperture_rad = std::numeric_limits<double>::infinity();
  EXPECT_EQ(limit(drive), LimitResult::NotFinite);
  EXPECT_FALSE(drive.locks());
}

TEST(AttitudeLimits, ClampsLeanTurnAndThrustAndReleasesWhenNotFinite) {
  QuadrotorAttitude command;
  command.set(0.1, -0.1, 0.2, 1.0);
  EXPECT_EQ(limit(command, 0.5, 1.0, 2.0), LimitResult::Passed);
  command.set(0.9, -0.9, 3.0, 2.5);
  EXPECT_EQ(limit(command, 0.5, 1.0, 2.0), LimitResult::Clamped);
  EXPECT_EQ(command.roll_rad, 0.5);
  EXPECT_EQ(command.pitch_rad, -0.5);
  EXPECT_EQ(command.yaw_rad_s, 1.0);
  EXPECT_EQ(command.thrust, 2.0);
  command.thrust = -1.0;
  EXPECT_EQ(limit(command, 0.5, 1.0, 2.0), LimitResult::Clamped);
  EXPECT_EQ(command.thrust, 0.0);
  for (double QuadrotorAttitude::*field : {&QuadrotorAttitude::roll_rad, &QuadrotorAttitude::pitch_rad,
                                           &QuadrotorAttitude::yaw_rad_s, &QuadrotorAttitude::thrust}) {
    command.set(0.1, 0.1, 0.1, 1.0);
    command.*field = std::numeric_limits<double>::quiet_NaN();
    EXPECT_EQ(limit(command, 0.5, 1.0, 2.0), LimitResult::NotFinite);
    EXPECT_FALSE(command.active);
  }
}

TEST(TaskLimits, ClampsTheSpeedAndKnowsItsOrders) {
  FlightTask command{{}, FlightOrder::TakeOff, 0.5};
  EXPECT_EQ(limit(command, 2.0), LimitResult::Passed);
  command.speed_m_s = 3.0;
  EXPECT_EQ(limit(command, 2.0), LimitResult::Clamped);
  EXPECT_EQ(command.speed_m_s, 2.0);
  command.speed_m_s = -1.0;
  EXPECT_EQ(limit(command, 2.0), LimitResult::Clamped);
  EXPECT_EQ(command.speed_m_s, 0.0);
  EXPECT_EQ(command.order, FlightOrder::TakeOff);
  command.speed_m_s = std::numeric_limits<double>::quiet_NaN();
  EXPECT_EQ(limit(command, 2.0), LimitResult::NotFinite);
  EXPECT_EQ(command.order, FlightOrder::Fly);
  command = {{}, static_cast<FlightOrder>(9), 0.0};
  EXPECT_EQ(limit(command, 2.0), LimitResult::NotFinite) << "an order that there is not";
  EXPECT_EQ(command.order, FlightOrder::Fly);
}

TEST(HeadLimits, ClampsTheTiltAndLooksDownWhenNotFinite) {
  PanTiltDrive command{{}, 9.0, 1.0, true};
  EXPECT_EQ(limit(command, 1.5), LimitResult::Passed);
  command.tilt_rad = -2.0;
  EXPECT_EQ(limit(command, 1.5), LimitResult::Clamped);
  EXPECT_EQ(command.tilt_rad, -1.5);
  EXPECT_TRUE(command.laser);
  command.pan_rad = std::numeric_limits<double>::infinity();
  EXPECT_EQ(limit(command, 1.5), LimitResult::NotFinite);
  EXPECT_EQ(command.tilt_rad, 0.0);
  EXPECT_FALSE(command.laser);
}

TEST(LimitOfABlock, AllowsNothingToAKindWithoutTheDevice) {
  std::array<WheelSpeeds, 1> wheels = {speeds(0.1, -0.1)};
  std::array<TurretDrive, 1> turrets;
  turrets[0].turn(1.0);
  Limited what;
  EXPECT_EQ(port_type<WheelSpeeds>().limit(wheels.data(), 0, 1, RobotKind{}, what), 0U);
  EXPECT_EQ(wheels[0].left_m_s, 0.0);
  EXPECT_EQ(port_type<TurretDrive>().limit(turrets.data(), 0, 1, RobotKind{}, what), 0U);
  EXPECT_EQ(turrets[0].speed_rad_s, 0.0);
}

TEST(LimitOfABlock, StopsAfterTheFirstThatItChangedAndTellsWhatItWas) {
  const PortType& type = port_type<WheelSpeeds>();
  std::array<WheelSpeeds, 4> block = {speeds(0.1, 0.1), speeds(0.4, -2.0), speeds(0.1, 0.1), speeds(0.0, NAN)};
  RobotKind slow;
  slow.locomotion = DifferentialDrive{.max_speed_m_s = 0.2};
  Limited what;
  ASSERT_EQ(type.limit(block.data(), 0, block.size(), slow, what), 1U);
  EXPECT_EQ(what.result, LimitResult::Clamped);
  EXPECT_EQ(what.asked_m_s, 2.0);
  EXPECT_EQ(what.most_m_s, 0.2);
  EXPECT_EQ(block[1].right_m_s, -0.2);
  EXPECT_TRUE(std::isnan(block[3].right_m_s)) << "not yet";
  ASSERT_EQ(type.limit(block.data(), 2, block.size(), slow, what), 3U);
  EXPECT_EQ(what.result, LimitResult::NotFinite);
  EXPECT_EQ(block[3].right_m_s, 0.0);
  EXPECT_EQ(type.limit(block.data(), 0, block.size(), slow, what), block.size());
}

TEST(LimitOfABlock, LampsHaveNone) {
  EXPECT_EQ(port_type<RingLeds>().limit, nullptr);
  EXPECT_EQ(port_type<FrontLed>().slow_down, nullptr);
}

TEST(SlowDown, HoldsWheelsAndFlightBackToOneSpeed) {
  WheelSpeeds wheels = speeds(0.3, -0.15);
  port_type<WheelSpeeds>().slow_down(&wheels, 0.1, nullptr);
  EXPECT_DOUBLE_EQ(wheels.left_m_s, 0.1);
  EXPECT_DOUBLE_EQ(wheels.right_m_s, -0.05);
  QuadrotorSpeed speed = flight(0.6, 0.0, 0.8, 0.3);
  port_type<QuadrotorSpeed>().slow_down(&speed, 0.1, nullptr);
  EXPECT_NEAR(speed.velocity[2], 0.08, 1e-12);
  EXPECT_EQ(speed.yaw_rad_s, 0.3);
}

TEST(SlowDown, DrawsATargetNearAlongTheLineToIt) {
  const Pose at{0.0, 0.0, 1.0};
  QuadrotorPosition wanted;
  wanted.set(3.0, 4.0, 1.0, 0.5);
  QuadrotorPosition near = wanted;
  near.slow_down(0.5, &at);
  EXPECT_FALSE(near.hold);
  EXPECT_NEAR(near.target[0], 0.3, 1e-12);
  EXPECT_NEAR(near.target[1], 0.4, 1e-12);
  EXPECT_NEAR(near.target[2], 1.0, 1e-12);
  EXPECT_EQ(near.yaw_rad, 0.5);
  near = wanted;
  near.slow_down(6.0, &at);
  EXPECT_EQ(near.target[0], 3.0);
  near.slow_down(0.0, &at);
  EXPECT_EQ(near.target[0], 0.0);
  near = wanted;
  near.slow_down(0.0, nullptr);
  EXPECT_EQ(near.target[0], 3.0) << "nobody knows where the robot is";
  near.hover();
  near.slow_down(0.0, &at);
  EXPECT_TRUE(near.hold);
}

TEST(SlowDown, WithoutALimitNothingChanges) {
  WheelSpeeds wheels = speeds(0.3, -0.15);
  wheels.slow_down(std::numeric_limits<double>::infinity(), nullptr);
  EXPECT_EQ(wheels.left_m_s, 0.3);
}

TEST(KeepOut, LeavesTurnsAndWhatLeadsOut) {
  const Pose east = Pose::at(0.0, 0.0, 0.0);
  WheelSpeeds wheels = speeds(0.1, 0.06);
  EXPECT_TRUE(port_type<WheelSpeeds>().keep_out(&wheels, east, -1.0, 0.0));
  EXPECT_NEAR(wheels.left_m_s, 0.02, 1e-12);
  EXPECT_NEAR(wheels.right_m_s, -0.02, 1e-12);
  wheels = speeds(-0.1, -0.1);
  EXPECT_FALSE(wheels.keep_out(east, -1.0, 0.0)) << "it comes out backwards";
  QuadrotorSpeed speed = flight(0.3, 0.2, 0.1, 0.0);
  EXPECT_TRUE(port_type<QuadrotorSpeed>().keep_out(&speed, east, -1.0, 0.0));
  EXPECT_EQ(speed.velocity, (std::array<double, 3>{0.0, 0.2, 0.1}));
}

}  // namespace
}  // namespace tandem::hal
