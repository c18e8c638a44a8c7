#include <cmath>
#include <gtest/gtest.h>

#include "hal/device/distance_scanner.hpp"
#include "hal/device/infrared_response.hpp"
#include "hal/device/leds.hpp"
#include "hal/device/ring_directions.hpp"
#include "hal/device/ring_sensors.hpp"
#include "hal/robot/epuck.hpp"
#include "hal/robot/eyebot.hpp"
#include "hal/robot/footbot.hpp"
#include "hal/robot/thymio.hpp"

namespace tandem::hal {
namespace {

TEST(Epuck, PutsItsSensorsOnTheRimWhereTheyLook) {
  for (const auto& ring : {epuck::kind().part<ProximityPart>()->mounts, epuck::kind().part<LightPart>()->mounts,
                           epuck::kind().part<LedsPart>()->mounts}) {
    EXPECT_EQ(ring.size(), 8U);
    for (const Mount& m : ring) {
      EXPECT_NEAR(std::hypot(m.x_m, m.y_m), epuck::kind().body.radius_m, 1e-12);
      EXPECT_NEAR(std::cos(m.bearing_rad), m.x_m / epuck::kind().body.radius_m, 1e-12);
      EXPECT_NEAR(std::sin(m.bearing_rad), m.y_m / epuck::kind().body.radius_m, 1e-12);
    }
  }
}

TEST(Epuck, IsSymmetricLeftAndRight) {
  for (std::size_t i = 0; i < 4; ++i) {
    EXPECT_DOUBLE_EQ(epuck::kind().part<ProximityPart>()->mounts[i].bearing_rad,
                     -epuck::kind().part<ProximityPart>()->mounts[7 - i].bearing_rad);
    EXPECT_LT(epuck::kind().part<ProximityPart>()->mounts[i].y_m, 0.0) << "the first four look to the right";
  }
}

TEST(Epuck, DrivesAtMostAThousandStepsASecond) {
  EXPECT_NEAR(epuck::kind().drive()->max_speed_m_s, 0.1288, 5e-5);
  EXPECT_NEAR(epuck::kind().drive()->max_speed_m_s, 2.0 * std::acos(-1.0) * epuck::kind().drive()->wheel_radius_m,
              1e-15)
      << "a turn has 1000 steps";
}

TEST(Epuck, HasAnInfraredCurveThatCanBeInverted) {
  const auto& curve = epuck::kind().part<ProximityPart>()->response;
  EXPECT_EQ(curve.front().distance_m, 0.0);
  EXPECT_EQ(curve.back().distance_m, epuck::kind().part<ProximityPart>()->range_m);
  EXPECT_EQ(curve.back().counts, 0.0);
  for (std::size_t i = 1; i < curve.size(); ++i) {
    EXPECT_GT(curve[i].distance_m, curve[i - 1].distance_m);
    EXPECT_LT(curve[i].counts, curve[i - 1].counts);
  }
}

TEST(Thymio, IsSymmetricLeftAndRightInFrontAndBehind) {
  const auto& ring = thymio::kind().part<ProximityPart>()->mounts;
  ASSERT_EQ(ring.size(), 7U);
  for (const auto& [left, right] : {std::pair{0U, 4U}, std::pair{1U, 3U}, std::pair{2U, 2U}}) {
    EXPECT_EQ(ring[left].bearing_rad, -ring[right].bearing_rad);
    EXPECT_EQ(ring[left].y_m, -ring[right].y_m);
    EXPECT_GE(ring[left].y_m, 0.0) << "the first looks to the left";
  }
  EXPECT_EQ(ring[5].y_m, -ring[6].y_m);
  EXPECT_LT(ring[5].x_m, 0.0);
  for (const Mount& m : ring) EXPECT_LE(std::hypot(m.x_m, m.y_m), thymio::kind().body.radius_m);
}

TEST(Thymio, HasAnInfraredCurveThatCanBeInverted) {
  const auto& part = *thymio::kind().part<ProximityPart>();
  EXPECT_EQ(part.response.front().counts, 4505.0);
  EXPECT_EQ(part.response.back().distance_m, part.range_m);
  EXPECT_EQ(part.response.back().counts, 0.0);
  for (std::size_t i = 1; i < part.response.size(); ++i) {
    EXPECT_GT(part.response[i].distance_m, part.response[i - 1].distance_m);
    EXPECT_LT(part.response[i].counts, part.response[i - 1].counts);
  }
  for (const double distance_m : {0.0, 0.02, 0.055, 0.13}) {
    EXPECT_NEAR(distance_m_of(part.response, counts_at(part.response, distance_m)), distance_m, 1e-12);
  }
}

TEST(Thymio, ShowsItsCircleClockwiseFromTheFrontAndItsTopLedLast) {
  const auto& leds = thymio::kind().part<LedsPart>()->mounts;
  ASSERT_EQ(leds.size(), thymio::kTop + 1);
  EXPECT_GT(leds[0].x_m, leds[4].x_m);
  EXPECT_LT(leds[2].y_m, 0.0) << "the right one";
  EXPECT_GT(leds[thymio::kBottomLeft].y_m, 0.0);
  EXPECT_EQ(leds[thymio::kTop].z_m, thymio::kind().body.height_m);
}

TEST(Eyebot, PutsItsSensorsOnTheRimWhereTheyLook) {
  constexpr double kRing_m = 0.255;
  const RobotKind& kind = eyebot::kind();
  EXPECT_EQ(kind.part<ProximityPart>()->mounts.size(), 24U);
  EXPECT_EQ(kind.part<LedsPart>()->mounts.size(), 16U);
  for (const auto& ring :
       {kind.part<ProximityPart>()->mounts, kind.part<LightPart>()->mounts, kind.part<LedsPart>()->mounts}) {
    const double step_rad = 2.0 * std::acos(-1.0) / static_cast<double>(ring.size());
    for (std::size_t i = 0; i < ring.size(); ++i) {
      const Mount& m = ring[i];
      EXPECT_NEAR(std::cos(m.bearing_rad), m.x_m / kRing_m, 1e-12);
      EXPECT_NEAR(std::sin(m.bearing_rad), m.y_m / kRing_m, 1e-12);
      EXPECT_LE(std::fabs(m.bearing_rad), std::acos(-1.0));
      const double next_rad = ring[(i + 1) % ring.size()].bearing_rad;
      EXPECT_NEAR(std::remainder(next_rad - m.bearing_rad - step_rad, 2.0 * std::acos(-1.0)), 0.0, 1e-12);
      EXPECT_LT(m.z_m, kind.body.height_m);
    }
  }
  EXPECT_NEAR(kind.part<ProximityPart>()->mounts[0].bearing_rad, 7.5 / 180.0 * std::acos(-1.0), 1e-12);
  EXPECT_NEAR(kind.part<LedsPart>()->mounts[0].bearing_rad, 11.25 / 180.0 * std::acos(-1.0), 1e-12);
}

TEST(Eyebot, FliesAndHasNoWheels) {
  const RobotKind& kind = eyebot::kind();
  EXPECT_TRUE(kind.flies());
  EXPECT_EQ(kind.drive(), nullptr);
  EXPECT_GT(kind.flight()->max_acceleration_m_s2, 0.0);
  // Stops before what its proximity sensors see from full speed.
  EXPECT_LT(kind.flight()->max_speed_m_s * kind.flight()->max_speed_m_s / (2.0 * kind.flight()->max_acceleration_m_s2),
            0.25 * kind.part<ProximityPart>()->range_m);
}

TEST(Footbot, PutsItsSensorsOnTheRimEvery15DegreesFromFrontLeft) {
  ASSERT_EQ(footbot::kind().part<ProximityPart>()->mounts.size(), 24U);
  for (std::size_t i = 0; i < 24; ++i) {
    const Mount& m = footbot::kind().part<ProximityPart>()->mounts[i];
    const double expected_deg = 7.5 + 15.0 * static_cast<double>(i);
    EXPECT_NEAR(std::remainder(m.bearing_rad - expected_deg * std::acos(-1.0) / 180.0, 2.0 * std::acos(-1.0)), 0.0,
                1e-12);
    EXPECT_NEAR(m.x_m, footbot::kind().body.radius_m * std::cos(m.bearing_rad), 1e-12);
    EXPECT_NEAR(m.y_m, footbot::kind().body.radius_m * std::sin(m.bearing_rad), 1e-12);
  }
  EXPECT_GT(footbot::kind().part<ProximityPart>()->mounts[0].y_m, 0.0)
      << "the first looks to the left of forward, the last to the right";
  EXPECT_LT(footbot::kind().part<ProximityPart>()->mounts[23].y_m, 0.0);
}

TEST(Footbot, HasTwelveLedsOutsideTheBodyAndABeaconAboveIt) {
  const LedsPart& part = *footbot::kind().part<LedsPart>();
  const auto& leds = part.mounts;
  ASSERT_EQ(leds.size(), 13U);
  for (std::size_t i = 0; i < 12; ++i) {
    EXPECT_NEAR(std::hypot(leds[i].x_m, leds[i].y_m), footbot::kind().body.radius_m + 0.005, 1e-12);
    EXPECT_LT(leds[i].z_m, footbot::kind().body.height_m);
  }
  EXPECT_NEAR(leds[0].bearing_rad, std::acos(-1.0) / 12.0, 1e-12);
  EXPECT_EQ(leds[part.beacon_led()].x_m, 0.0);
  EXPECT_EQ(leds[part.beacon_led()].y_m, 0.0);
  EXPECT_GT(leds[part.beacon_led()].z_m, footbot::kind().body.height_m);
}

TEST(Footbot, SeesTheFloorUnderItsBodyOnAllSides) {
  for (const auto& sensors :
       {footbot::kind().part<BaseGroundPart>()->mounts, footbot::kind().part<MotorGroundPart>()->mounts}) {
    double x = 0.0, y = 0.0;
    for (const Mount& m : sensors) {
      EXPECT_LT(std::hypot(m.x_m, m.y_m), footbot::kind().body.radius_m);
      x += m.x_m;
      y += m.y_m;
    }
    EXPECT_NEAR(x, 0.0, 1e-12);
    EXPECT_NEAR(y, 0.0, 1e-12);
  }
  EXPECT_EQ(footbot::kind().part<BaseGroundPart>()->mounts.size(), 8U);
  EXPECT_EQ(footbot::kind().part<MotorGroundPart>()->mounts.size(), 4U);
}

TEST(Footbot, ScansShortAndLongDistancesByTurns) {
  const auto heads = footbot::kind().part<ScannerPart>()->heads;
  ASSERT_EQ(heads.size(), DistanceScanner::kHeads);
  for (std::size_t i = 0; i < heads.size(); ++i) {
    EXPECT_NEAR(std::sin(heads[i].bearing_rad - 0.5 * std::acos(-1.0) * static_cast<double>(i)), 0.0, 1e-12);
    EXPECT_EQ(heads[i].max_m, DistanceScanner::is_short(i) ? 0.3 : 1.5);
    EXPECT_LT(heads[i].min_m, heads[i].max_m);
  }
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
  const RingDirections& d = ring_directions(epuck::kind().part<ProximityPart>()->mounts);
  for (std::size_t i = 0; i < 8; ++i) {
    EXPECT_NEAR(d.x[i], std::cos(epuck::kind().part<ProximityPart>()->mounts[i].bearing_rad), 1e-7);
    EXPECT_NEAR(d.y[i], std::sin(epuck::kind().part<ProximityPart>()->mounts[i].bearing_rad), 1e-7);
  }
  EXPECT_EQ(d.x[8], 0.0F);
  EXPECT_EQ(&ring_directions(epuck::kind().part<ProximityPart>()->mounts), &d);
  EXPECT_NE(&ring_directions(epuck::kind().part<LedsPart>()->mounts), &d);
}

}  // namespace
}  // namespace tandem::hal
