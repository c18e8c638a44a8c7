#include "bridges/epuck/conversions.hpp"

#include <cmath>
#include <gtest/gtest.h>
#include <limits>
#include <numbers>
#include <rapidcheck/gtest.h>

#include "bridges/epuck/wire.hpp"
#include "hal/device/body_sensors.hpp"
#include "hal/device/ring_sensors.hpp"
#include "hal/robot/epuck.hpp"

namespace tandem::bridges::epuck {
namespace {

const Conversions kUnits{hal::epuck::kind()};

namespace spec = hal::epuck;

TEST(EpuckSpeed, IsAThousandStepsATurn) {
  const double one_turn_s = std::numbers::pi * 0.041;
  EXPECT_EQ(kUnits.to_steps_per_s(one_turn_s).value, 1000);
  EXPECT_EQ(kUnits.to_steps_per_s(-one_turn_s / 2).value, -500);
  EXPECT_NEAR(kUnits.to_m_s(StepsPerS{1000}), one_turn_s, 1e-12);
}

TEST(EpuckSpeed, StaysWithinWhatTheFirmwareTakes) {
  EXPECT_EQ(kUnits.to_steps_per_s(1e9).value, 1000);
  EXPECT_EQ(kUnits.to_steps_per_s(-1e9).value, -1000);
  EXPECT_EQ(kUnits.to_steps_per_s(std::numeric_limits<double>::quiet_NaN()).value, 0);
  EXPECT_EQ(kUnits.to_steps_per_s(std::numeric_limits<double>::infinity()).value, 0);
}

TEST(EpuckEncoders, GoRoundTheShortWay) {
  EXPECT_EQ(encoder_difference(-32768, 32767), 1);
  EXPECT_EQ(encoder_difference(32767, -32768), -1);
  EXPECT_EQ(encoder_difference(100, -100), 200);
  EXPECT_EQ(encoder_difference(0, 0), 0);
  EXPECT_NEAR(kUnits.steps_to_m(1000), 0.1288, 1e-4);
}

RC_GTEST_PROP(EpuckEncodersProperty, AddUpToTheWayRolled, (const std::vector<std::int16_t>& moves)) {
  std::int64_t truth = 0;
  std::int64_t counted = 0;
  std::int16_t counter = 0;
  for (const std::int16_t move : moves) {
    truth += move;
    const auto next = static_cast<std::int16_t>(truth);
    counted += encoder_difference(next, counter);
    counter = next;
  }
  RC_ASSERT(counted == truth);
}

TEST(EpuckProximity, MeetsTheCurveAtItsKnots) {
  for (const hal::InfraredResponse& knot : spec::kind().part<hal::ProximityPart>()->response) {
    EXPECT_NEAR(kUnits.proximity_distance_m(knot.counts), knot.distance_m, 1e-12);
    EXPECT_NEAR(kUnits.proximity_counts(knot.distance_m), knot.counts, 1e-9);
  }
}

TEST(EpuckProximity, EndsAtContactAndAtItsRange) {
  EXPECT_EQ(kUnits.proximity_distance_m(1e6), 0.0);
  EXPECT_EQ(kUnits.proximity_distance_m(0.0), spec::kind().part<hal::ProximityPart>()->range_m);
  EXPECT_EQ(kUnits.proximity_distance_m(-5.0), spec::kind().part<hal::ProximityPart>()->range_m);
  EXPECT_EQ(kUnits.proximity_counts(1.0), 0.0);
  EXPECT_EQ(kUnits.proximity_distance_m(std::numeric_limits<double>::quiet_NaN()),
            spec::kind().part<hal::ProximityPart>()->range_m);
}

RC_GTEST_PROP(EpuckProximityProperty, IsTheCurveReadBackwards, ()) {
  const double distance = *rc::gen::inRange(0, 100001) * 1e-6;
  RC_ASSERT(std::fabs(kUnits.proximity_distance_m(kUnits.proximity_counts(distance)) - distance) < 1e-9);
}

RC_GTEST_PROP(EpuckProximityProperty, FallsWithDistance, ()) {
  const int a = *rc::gen::inRange(0, 4096);
  const int b = *rc::gen::inRange(0, 4096);
  RC_PRE(a < b);
  RC_ASSERT(kUnits.proximity_distance_m(a) >= kUnits.proximity_distance_m(b));
}

TEST(EpuckLight, IsDarkAtFullCounts) {
  EXPECT_DOUBLE_EQ(light_level(4095), 0.0);
  EXPECT_DOUBLE_EQ(light_level(0), 1.0);
  EXPECT_GT(light_level(300), light_level(3000));
  EXPECT_DOUBLE_EQ(light_level(65535), 0.0);
}

TEST(EpuckGround, IsBlackAtZeroAndWhiteAtFullScale) {
  EXPECT_DOUBLE_EQ(ground_reflectance(0), 0.0);
  EXPECT_DOUBLE_EQ(ground_reflectance(wire::kGroundWhiteRaw), 1.0);
  EXPECT_DOUBLE_EQ(ground_reflectance(65535), 1.0);
}

TEST(EpuckBattery, IsLinearBetweenTheDocumentedPoints) {
  EXPECT_NEAR(kUnits.battery_state(2070, Firmware::GCtronic).supply_V, 3.4, 1e-9);
  EXPECT_NEAR(kUnits.battery_state(2070, Firmware::GCtronic).charge, 0.0, 1e-9);
  EXPECT_NEAR(kUnits.battery_state(2560, Firmware::GCtronic).supply_V, 4.2, 1e-9);
  EXPECT_NEAR(kUnits.battery_state(2560, Firmware::GCtronic).charge, 1.0, 1e-9);
  EXPECT_NEAR(kUnits.battery_state(2315, Firmware::GCtronic).charge, 0.5, 1e-9);
  EXPECT_EQ(kUnits.battery_state(65535, Firmware::GCtronic).charge, 1.0);
}

TEST(EpuckBattery, KnowsOnlyGoodOrLowOnOldBoards) {
  EXPECT_EQ(kUnits.battery_state(0, Firmware::GCtronic).charge, 0.0);
  EXPECT_EQ(kUnits.battery_state(1, Firmware::GCtronic).charge, 0.5);
  EXPECT_GT(kUnits.battery_state(1, Firmware::GCtronic).supply_V, spec::kind().part<hal::BatteryPart>()->empty_V);
}

TEST(EpuckBattery, StandsBehindADividerOnTheEpuck2) {
  EXPECT_NEAR(kUnits.battery_state(3000, Firmware::Epuck2).supply_V, 3000 * 3.0 / 4096 * 550 / 330, 1e-9);
}

TEST(EpuckLamp, IsOnAboveHalfOfAnyChannel) {
  EXPECT_FALSE(lamp_on({127, 127, 127}));
  EXPECT_TRUE(lamp_on({0, 128, 0}));
  EXPECT_EQ(to_percent(0), 0);
  EXPECT_EQ(to_percent(255), 100);
  EXPECT_EQ(to_percent(128), 50);
}

TEST(EpuckSound, IsFullAtTwelveBits) {
  EXPECT_DOUBLE_EQ(sound_level(0), 0.0);
  EXPECT_DOUBLE_EQ(sound_level(4095), 1.0);
}

}  // namespace
}  // namespace tandem::bridges::epuck
