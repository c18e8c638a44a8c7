#include "bridges/thymio/units.hpp"

#include <gtest/gtest.h>
#include <limits>

namespace tandem::bridges::thymio {
namespace {

TEST(ThymioUnits, MotorsTakeTheirTargetByTheSpeedAt500) {
  EXPECT_EQ(motor_target(0.2, 0.2), 500);
  EXPECT_EQ(motor_target(-0.05, 0.2), -125);
  EXPECT_EQ(motor_target(3.0, 0.2), 500);
  EXPECT_EQ(motor_target(0.083, 0.166), 250);
  EXPECT_EQ(motor_target(std::numeric_limits<double>::quiet_NaN(), 0.2), 0);
  EXPECT_DOUBLE_EQ(motor_m_s(-250, 0.166), -0.083);
}

TEST(ThymioUnits, SensorsAreSi) {
  EXPECT_NEAR(acceleration_m_s2(23), 9.81, 1e-12);
  EXPECT_EQ(sound_level(255), 1.0);
  EXPECT_EQ(reflectance(1000, 820.0), 1.0);
  EXPECT_EQ(reflectance(410, 820.0), 0.5);
}

TEST(ThymioUnits, LampsGoTo32) {
  EXPECT_EQ(lamp(255), 32);
  EXPECT_EQ(lamp(128), 16);
  EXPECT_EQ(lamp(0), 0);
  EXPECT_EQ(yellow_lamp({10, 255, 0}), 32);
}

}  // namespace
}  // namespace tandem::bridges::thymio
