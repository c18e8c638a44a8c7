#include <cmath>
#include <gtest/gtest.h>

#include "hal/device/distance_scanner.hpp"
#include "hal/spec/epuck.hpp"
#include "hal/spec/eyebot.hpp"
#include "hal/spec/footbot.hpp"
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

TEST(FootbotDataSheet, PutsItsSensorsOnTheRimEvery15DegreesFromFrontLeft) {
  ASSERT_EQ(footbot::kDataSheet.proximity.size(), 24U);
  for (std::size_t i = 0; i < 24; ++i) {
    const Mount& m = footbot::kDataSheet.proximity[i];
    const double expected_deg = 7.5 + 15.0 * static_cast<double>(i);
    EXPECT_NEAR(std::remainder(m.bearing_rad - expected_deg * std::acos(-1.0) / 180.0, 2.0 * std::acos(-1.0)), 0.0,
                1e-12);
    EXPECT_NEAR(m.x_m, footbot::kBodyRadius_m * std::cos(m.bearing_rad), 1e-12);
    EXPECT_NEAR(m.y_m, footbot::kBodyRadius_m * std::sin(m.bearing_rad), 1e-12);
  }
  EXPECT_GT(footbot::kRing[0].y_m, 0.0) << "the first looks to the left of forward, the last to the right";
  EXPECT_LT(footbot::kRing[23].y_m, 0.0);
}

TEST(FootbotDataSheet, HasTwelveLedsOutsideTheBodyAndABeaconAboveIt) {
  const auto leds = footbot::kDataSheet.leds;
  ASSERT_EQ(leds.size(), 13U);
  for (std::size_t i = 0; i < footbot::kRingLeds; ++i) {
    EXPECT_NEAR(std::hypot(leds[i].x_m, leds[i].y_m), footbot::kLedRadius_m, 1e-12);
    EXPECT_LT(leds[i].z_m, footbot::kHeight_m);
  }
  EXPECT_NEAR(leds[0].bearing_rad, std::acos(-1.0) / 12.0, 1e-12);
  EXPECT_EQ(leds[footbot::kBeacon].x_m, 0.0);
  EXPECT_EQ(leds[footbot::kBeacon].y_m, 0.0);
  EXPECT_GT(leds[footbot::kBeacon].z_m, footbot::kHeight_m);
}

TEST(FootbotDataSheet, SeesTheFloorUnderItsBodyOnAllSides) {
  for (const auto& sensors : {footbot::kDataSheet.base_ground, footbot::kDataSheet.motor_ground}) {
    double x = 0.0, y = 0.0;
    for (const Mount& m : sensors) {
      EXPECT_LT(std::hypot(m.x_m, m.y_m), footbot::kBodyRadius_m);
      x += m.x_m;
      y += m.y_m;
    }
    EXPECT_NEAR(x, 0.0, 1e-12);
    EXPECT_NEAR(y, 0.0, 1e-12);
  }
  EXPECT_EQ(footbot::kBaseGround.size(), 8U);
  EXPECT_EQ(footbot::kMotorGround.size(), 4U);
}

TEST(FootbotDataSheet, ScansShortAndLongDistancesByTurns) {
  const auto heads = footbot::kDataSheet.scanner;
  ASSERT_EQ(heads.size(), DistanceScanner::kHeads);
  for (std::size_t i = 0; i < heads.size(); ++i) {
    EXPECT_NEAR(std::sin(heads[i].bearing_rad - 0.5 * std::acos(-1.0) * static_cast<double>(i)), 0.0, 1e-12);
    EXPECT_EQ(heads[i].max_m, DistanceScanner::is_short(i) ? 0.3 : 1.5);
    EXPECT_LT(heads[i].min_m, heads[i].max_m);
  }
}

TEST(FootbotDataSheet, DrivesAtMostSeventyTwoPulsesAPeriod) {
  const double pulses = footbot::kMaxWheelSpeed_m_s * footbot::kPulsesPerMetre * footbot::kPulsePeriod_s;
  EXPECT_EQ(std::floor(pulses), 72.0);
}

TEST(DistanceScanner, TellsNothingAndTooNearFromWhatItMeasures) {
  DistanceScanner port;
  port.samples = 2;
  port.count = 8;
  port.short_min_m = 0.04F;
  port.short_max_m = 0.3F;
  port.long_min_m = 0.2F;
  port.long_max_m = 1.5F;
  port.distance_m[port.at(0, 1)] = 0.3F;
  port.distance_m[port.at(1, 0)] = 0.3F;
  port.distance_m[port.at(3, 1)] = 0.2F;
  EXPECT_TRUE(port.sees_nothing(0, 1));
  EXPECT_FALSE(port.sees_nothing(1, 0)) << "that head sees farther";
  EXPECT_TRUE(port.too_near(3, 1));
  EXPECT_FALSE(port.too_near(1, 0));
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
