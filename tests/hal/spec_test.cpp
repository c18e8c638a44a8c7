#include <cmath>
#include <gtest/gtest.h>

#include "hal/spec/epuck.hpp"
#include "hal/spec/eyebot.hpp"
#include "hal/spec/ring_directions.hpp"

namespace tandem::hal {
namespace {

TEST(EpuckDataSheet, PutsItsSensorsOnTheRimWhereTheyLook) {
  for (const auto& ring : {epuck::kDataSheet.proximity, epuck::kDataSheet.light, epuck::kDataSheet.leds}) {
    EXPECT_EQ(ring.size(), 8U);
    for (const Mount& m : ring) {
      EXPECT_NEAR(std::hypot(m.x_m, m.y_m), epuck::kBodyRadius_m, 1e-12);
      EXPECT_NEAR(std::cos(m.bearing_rad), m.x_m / epuck::kBodyRadius_m, 1e-12);
      EXPECT_NEAR(std::sin(m.bearing_rad), m.y_m / epuck::kBodyRadius_m, 1e-12);
    }
  }
}

TEST(EpuckDataSheet, IsSymmetricLeftAndRight) {
  for (std::size_t i = 0; i < 4; ++i) {
    EXPECT_DOUBLE_EQ(epuck::kInfrared[i].bearing_rad, -epuck::kInfrared[7 - i].bearing_rad);
    EXPECT_LT(epuck::kInfrared[i].y_m, 0.0) << "the first four look to the right";
  }
}

TEST(EpuckDataSheet, DrivesAtMostAThousandStepsASecond) {
  EXPECT_NEAR(epuck::kDataSheet.max_wheel_speed_m_s, 0.1288, 5e-5);
  EXPECT_NEAR(epuck::kMetresPerStep * epuck::kStepsPerTurn, 2.0 * std::acos(-1.0) * epuck::kWheelRadius_m, 1e-15);
}

TEST(EpuckDataSheet, HasAnInfraredCurveThatCanBeInverted) {
  const auto& curve = epuck::kInfraredCurve;
  EXPECT_EQ(curve.front().distance_m, 0.0);
  EXPECT_EQ(curve.back().distance_m, epuck::kProximityRange_m);
  EXPECT_EQ(curve.back().counts, 0.0);
  for (std::size_t i = 1; i < curve.size(); ++i) {
    EXPECT_GT(curve[i].distance_m, curve[i - 1].distance_m);
    EXPECT_LT(curve[i].counts, curve[i - 1].counts);
  }
}

TEST(EyebotDataSheet, PutsItsSensorsOnTheRimWhereTheyLook) {
  const DataSheet& sheet = eyebot::kDataSheet;
  EXPECT_EQ(sheet.proximity.size(), 24U);
  EXPECT_EQ(sheet.leds.size(), 16U);
  for (const auto& ring : {sheet.proximity, sheet.light, sheet.leds}) {
    const double step_rad = 2.0 * std::acos(-1.0) / static_cast<double>(ring.size());
    for (std::size_t i = 0; i < ring.size(); ++i) {
      const Mount& m = ring[i];
      EXPECT_NEAR(std::cos(m.bearing_rad), m.x_m / eyebot::kRingRadius_m, 1e-12);
      EXPECT_NEAR(std::sin(m.bearing_rad), m.y_m / eyebot::kRingRadius_m, 1e-12);
      EXPECT_LE(std::fabs(m.bearing_rad), std::acos(-1.0));
      const double next_rad = ring[(i + 1) % ring.size()].bearing_rad;
      EXPECT_NEAR(std::remainder(next_rad - m.bearing_rad - step_rad, 2.0 * std::acos(-1.0)), 0.0, 1e-12);
      EXPECT_LT(m.z_m, sheet.body_height_m);
    }
  }
  EXPECT_NEAR(sheet.proximity[0].bearing_rad, 7.5 / 180.0 * std::acos(-1.0), 1e-12);
  EXPECT_NEAR(sheet.leds[0].bearing_rad, 11.25 / 180.0 * std::acos(-1.0), 1e-12);
}

TEST(EyebotDataSheet, FliesAndHasNoWheels) {
  const DataSheet& sheet = eyebot::kDataSheet;
  EXPECT_TRUE(sheet.flies);
  EXPECT_EQ(sheet.wheel_base_m, 0.0);
  EXPECT_GT(sheet.max_flight_acceleration_m_s2, 0.0);
  // Stops before what its proximity sensors see from full speed.
  EXPECT_LT(sheet.max_flight_speed_m_s * sheet.max_flight_speed_m_s / (2.0 * sheet.max_flight_acceleration_m_s2),
            0.25 * sheet.proximity_range_m);
}

TEST(RingDirections, AreUnitVectorsSharedByAllOfAKind) {
  const RingDirections& d = ring_directions(epuck::kDataSheet.proximity);
  for (std::size_t i = 0; i < 8; ++i) {
    EXPECT_NEAR(d.x[i], std::cos(epuck::kInfrared[i].bearing_rad), 1e-7);
    EXPECT_NEAR(d.y[i], std::sin(epuck::kInfrared[i].bearing_rad), 1e-7);
  }
  EXPECT_EQ(d.x[8], 0.0F);
  EXPECT_EQ(&ring_directions(epuck::kDataSheet.proximity), &d);
  EXPECT_NE(&ring_directions(epuck::kDataSheet.leds), &d);
}

}  // namespace
}  // namespace tandem::hal
