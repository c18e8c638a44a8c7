#include "hal/vector.hpp"

#include <gtest/gtest.h>
#include <numbers>

#include "hal/angle.hpp"

namespace tandem::hal {
namespace {

constexpr double kPi = std::numbers::pi;

TEST(Angle, WrappedLiesBetweenMinusPiAndPi) {
  EXPECT_DOUBLE_EQ(wrapped(kPi), kPi);
  EXPECT_DOUBLE_EQ(wrapped(-kPi), kPi);
  EXPECT_NEAR(wrapped(7.0), 7.0 - 2.0 * kPi, 1e-12);
  EXPECT_NEAR(wrapped(-20.0), -20.0 + 6.0 * kPi, 1e-12);
  EXPECT_EQ(wrapped(0.5), 0.5);
}

TEST(Angle, TurnsGoTheShorterWay) {
  EXPECT_NEAR(turn_between(3.0, -3.0), 2.0 * kPi - 6.0, 1e-12);
  EXPECT_NEAR(turn_between(-3.0, 3.0), 6.0 - 2.0 * kPi, 1e-12);
  EXPECT_DOUBLE_EQ(turn_between(1.0, 1.5), 0.5);
}

TEST(Vector, PointsAndTurns) {
  const Vector2 v = polar(2.0, 0.5);
  EXPECT_NEAR(length_of(v), 2.0, 1e-15);
  EXPECT_NEAR(bearing_of(v), 0.5, 1e-15);
  EXPECT_NEAR(bearing_of(turned(v, 1.0)), 1.5, 1e-15);
  EXPECT_EQ(bearing_of(Vector2::Zero()), 0.0);
}

TEST(Vector, RotationsTurnVectors) {
  const Quaternion q = about_z(0.7) * about_z(0.3);
  EXPECT_NEAR(heading_of(q), 1.0, 1e-15);
  const Vector3 x = q * Vector3(1.0, 0.0, 0.0);
  EXPECT_NEAR(x.x(), std::cos(1.0), 1e-15);
  EXPECT_NEAR(x.y(), std::sin(1.0), 1e-15);
  EXPECT_NEAR(x.z(), 0.0, 1e-15);
}

TEST(Vector, NeedsNoMoreAlignmentThanADouble) {
  EXPECT_EQ(alignof(Vector2), alignof(double));
  EXPECT_EQ(alignof(Quaternion), alignof(double));
  EXPECT_EQ(sizeof(Vector3), 3 * sizeof(double));
}

}  // namespace
}  // namespace tandem::hal
