#include "hal/filter.hpp"

#include <cmath>
#include <gtest/gtest.h>
#include <limits>
#include <rapidcheck.h>

namespace tandem::hal {
namespace {

WheelSpeeds speeds(double left, double right) {
  WheelSpeeds w;
  w.set(left, right);
  return w;
}

TEST(Filter, PassesWhatIsWithinTheLimit) {
  WheelSpeeds w = speeds(0.1, -0.05);
  EXPECT_EQ(filter(w, 0.1), FilterResult::Passed);
  EXPECT_EQ(w.left_m_s, 0.1);
  EXPECT_EQ(w.right_m_s, -0.05);
}

TEST(Filter, ClampsBothWheelsByTheSameFactor) {
  WheelSpeeds w = speeds(-0.4, 0.2);
  EXPECT_EQ(filter(w, 0.1), FilterResult::Clamped);
  EXPECT_DOUBLE_EQ(w.left_m_s, -0.1);
  EXPECT_DOUBLE_EQ(w.right_m_s, 0.05);
}

TEST(Filter, StopsWhatIsNotFinite) {
  constexpr double kNan = std::numeric_limits<double>::quiet_NaN();
  constexpr double kInf = std::numeric_limits<double>::infinity();
  for (WheelSpeeds w :
       {speeds(kNan, 0.0), speeds(0.0, kNan), speeds(kInf, 0.0), speeds(0.01, -kInf), speeds(kNan, kInf)}) {
    EXPECT_EQ(filter(w, 0.1), FilterResult::NotFinite);
    EXPECT_EQ(w.left_m_s, 0.0);
    EXPECT_EQ(w.right_m_s, 0.0);
  }
}

TEST(Filter, NeverLeavesMoreThanTheLimitAndKeepsTheCurve) {
  EXPECT_TRUE(rc::check([](double left, double right) {
    WheelSpeeds w = speeds(left, right);
    const FilterResult result = filter(w, 0.128);
    RC_ASSERT(std::fabs(w.left_m_s) <= 0.128 * (1.0 + 1e-15));
    RC_ASSERT(std::fabs(w.right_m_s) <= 0.128 * (1.0 + 1e-15));
    if (result == FilterResult::Passed) RC_ASSERT(w.left_m_s == left && w.right_m_s == right);
    if (result == FilterResult::Clamped && std::fabs(left) > 1e-200 && std::fabs(right) > 1e-200) {
      const double before = left / right;
      if (std::isnormal(before) && std::fabs(w.right_m_s) > 1e-200)
        RC_ASSERT(std::fabs(w.left_m_s / w.right_m_s - before) <= 1e-12 * std::fabs(before));
    }
  }));
}

TEST(Filter, ALimitOfZeroStops) {
  WheelSpeeds w = speeds(0.1, 0.1);
  EXPECT_EQ(filter(w, 0.0), FilterResult::Clamped);
  EXPECT_EQ(w.left_m_s, 0.0);
}

QuadrotorSpeed flight(double x, double y, double z, double turn) {
  QuadrotorSpeed f;
  f.set(x, y, z, turn);
  return f;
}

TEST(FlightFilter, PassesWhatIsWithinTheLimits) {
  QuadrotorSpeed f = flight(1.0, -1.0, 0.5, 0.7);
  EXPECT_EQ(filter(f, 1.5, 0.7), FilterResult::Passed);
  EXPECT_EQ(f.velocity, (std::array<double, 3>{1.0, -1.0, 0.5}));
  EXPECT_EQ(f.yaw_rad_s, 0.7);
}

TEST(FlightFilter, KeepsTheDirectionOfWhatIsTooFast) {
  QuadrotorSpeed f = flight(3.0, 0.0, -4.0, -9.0);
  EXPECT_EQ(filter(f, 2.0, 1.5), FilterResult::Clamped);
  EXPECT_DOUBLE_EQ(f.velocity[0], 1.2);
  EXPECT_EQ(f.velocity[1], 0.0);
  EXPECT_DOUBLE_EQ(f.velocity[2], -1.6);
  EXPECT_EQ(f.yaw_rad_s, -1.5);
  QuadrotorSpeed turns = flight(0.1, 0.2, 0.3, 9.0);
  EXPECT_EQ(filter(turns, 2.0, 1.5), FilterResult::Clamped);
  EXPECT_EQ(turns.velocity, (std::array<double, 3>{0.1, 0.2, 0.3}));
  EXPECT_EQ(turns.yaw_rad_s, 1.5);
}

TEST(FlightFilter, NeverLeavesMoreThanTheLimits) {
  EXPECT_TRUE(rc::check([](double x, double y, double z, double turn) {
    QuadrotorSpeed f = flight(x, y, z, turn);
    filter(f, 2.0, 1.5);
    RC_ASSERT(std::hypot(f.velocity[0], f.velocity[1], f.velocity[2]) <= 2.0 * (1.0 + 1e-15));
    RC_ASSERT(std::fabs(f.yaw_rad_s) <= 1.5);
  }));
  QuadrotorSpeed f = flight(1e308, 1e308, -1e308, 1e308);  // its length is no number
  EXPECT_EQ(filter(f, 3.0, 1.5), FilterResult::Clamped);
  EXPECT_NEAR(f.velocity[2], -std::sqrt(3.0), 1e-12);
}

TEST(FlightFilter, HoversWhereACommandIsNotFinite) {
  constexpr double kNan = std::numeric_limits<double>::quiet_NaN();
  constexpr double kInf = std::numeric_limits<double>::infinity();
  for (QuadrotorSpeed f :
       {flight(kNan, 0, 0, 0), flight(0, kInf, 0, 0), flight(1, 0, -kInf, 0), flight(1, 1, 1, kNan)}) {
    EXPECT_EQ(filter(f, 2.0, 1.5), FilterResult::NotFinite);
    EXPECT_EQ(f.velocity, (std::array<double, 3>{}));
    EXPECT_EQ(f.yaw_rad_s, 0.0);
  }
  QuadrotorPosition p;
  p.set(1, 2, 3, 0.4);
  EXPECT_EQ(filter(p), FilterResult::Passed);
  EXPECT_FALSE(p.hold);
  EXPECT_EQ(p.target[2], 3.0);
  for (const std::size_t bad : {0U, 1U, 2U, 3U}) {
    p.set(1, 2, 3, 0.4);
    (bad < 3 ? p.target[bad] : p.yaw_rad) = bad % 2 == 0 ? kNan : kInf;
    EXPECT_EQ(filter(p), FilterResult::NotFinite) << bad;
    EXPECT_TRUE(p.hold);
    EXPECT_EQ(p.target[0], 0.0);
  }
}

template <class Drive>
class TurnFilter : public testing::Test {};
using TurnDrives = testing::Types<TurretDrive, ScannerDrive>;
TYPED_TEST_SUITE(TurnFilter, TurnDrives);

TYPED_TEST(TurnFilter, ClampsSpeedsAndStopsWhatIsNotFinite) {
  constexpr double kNan = std::numeric_limits<double>::quiet_NaN();
  TypeParam drive;
  drive.turn(1.0);
  EXPECT_EQ(filter(drive, 1.0), FilterResult::Passed);
  drive.turn(-3.0);
  EXPECT_EQ(filter(drive, 1.0), FilterResult::Clamped);
  EXPECT_EQ(drive.speed_rad_s, -1.0);
  drive.turn(kNan);
  EXPECT_EQ(filter(drive, 1.0), FilterResult::NotFinite);
  EXPECT_EQ(drive.mode, decltype(drive.mode){}) << "off";
  drive.go_to(kNan);
  EXPECT_EQ(filter(drive, 1.0), FilterResult::NotFinite);
  EXPECT_EQ(drive.angle_rad, 0.0);
  drive.mode = static_cast<decltype(drive.mode)>(17);
  EXPECT_EQ(filter(drive, 1.0), FilterResult::NotFinite) << "a mode that there is not";
  EXPECT_EQ(drive.mode, decltype(drive.mode){});
}

TEST(GripperFilter, ClampsTheApertureAndLetsGoWhenItIsNotFinite) {
  GripperDrive drive;
  drive.lock();
  EXPECT_TRUE(drive.locks());
  EXPECT_EQ(filter(drive), FilterResult::Passed);
  drive.aperture_rad = -2.0;
  EXPECT_EQ(filter(drive), FilterResult::Clamped);
  EXPECT_EQ(drive.aperture_rad, -GripperDrive::kMost_rad);
  EXPECT_TRUE(drive.locks());
  drive.aperture_rad = std::numeric_limits<double>::infinity();
  EXPECT_EQ(filter(drive), FilterResult::NotFinite);
  EXPECT_FALSE(drive.locks());
}

TEST(AttitudeFilter, ClampsLeanTurnAndThrustAndReleasesWhenNotFinite) {
  QuadrotorAttitude command;
  command.set(0.1, -0.1, 0.2, 1.0);
  EXPECT_EQ(filter(command, 0.5, 1.0, 2.0), FilterResult::Passed);
  command.set(0.9, -0.9, 3.0, 2.5);
  EXPECT_EQ(filter(command, 0.5, 1.0, 2.0), FilterResult::Clamped);
  EXPECT_EQ(command.roll_rad, 0.5);
  EXPECT_EQ(command.pitch_rad, -0.5);
  EXPECT_EQ(command.yaw_rad_s, 1.0);
  EXPECT_EQ(command.thrust, 2.0);
  command.thrust = -1.0;
  EXPECT_EQ(filter(command, 0.5, 1.0, 2.0), FilterResult::Clamped);
  EXPECT_EQ(command.thrust, 0.0);
  for (double QuadrotorAttitude::*field : {&QuadrotorAttitude::roll_rad, &QuadrotorAttitude::pitch_rad,
                                           &QuadrotorAttitude::yaw_rad_s, &QuadrotorAttitude::thrust}) {
    command.set(0.1, 0.1, 0.1, 1.0);
    command.*field = std::numeric_limits<double>::quiet_NaN();
    EXPECT_EQ(filter(command, 0.5, 1.0, 2.0), FilterResult::NotFinite);
    EXPECT_FALSE(command.active);
  }
}

TEST(TaskFilter, ClampsTheSpeedAndKnowsItsOrders) {
  FlightTask command{{}, FlightOrder::TakeOff, 0.5};
  EXPECT_EQ(filter(command, 2.0), FilterResult::Passed);
  command.speed_m_s = 3.0;
  EXPECT_EQ(filter(command, 2.0), FilterResult::Clamped);
  EXPECT_EQ(command.speed_m_s, 2.0);
  command.speed_m_s = -1.0;
  EXPECT_EQ(filter(command, 2.0), FilterResult::Clamped);
  EXPECT_EQ(command.speed_m_s, 0.0);
  EXPECT_EQ(command.order, FlightOrder::TakeOff);
  command.speed_m_s = std::numeric_limits<double>::quiet_NaN();
  EXPECT_EQ(filter(command, 2.0), FilterResult::NotFinite);
  EXPECT_EQ(command.order, FlightOrder::Fly);
  command = {{}, static_cast<FlightOrder>(9), 0.0};
  EXPECT_EQ(filter(command, 2.0), FilterResult::NotFinite) << "an order that there is not";
  EXPECT_EQ(command.order, FlightOrder::Fly);
}

TEST(HeadFilter, ClampsTheTiltAndLooksDownWhenNotFinite) {
  PanTiltDrive command{{}, 9.0, 1.0, true};
  EXPECT_EQ(filter(command, 1.5), FilterResult::Passed);
  command.tilt_rad = -2.0;
  EXPECT_EQ(filter(command, 1.5), FilterResult::Clamped);
  EXPECT_EQ(command.tilt_rad, -1.5);
  EXPECT_TRUE(command.laser);
  command.pan_rad = std::numeric_limits<double>::infinity();
  EXPECT_EQ(filter(command, 1.5), FilterResult::NotFinite);
  EXPECT_EQ(command.tilt_rad, 0.0);
  EXPECT_FALSE(command.laser);
}

}  // namespace
}  // namespace tandem::hal
