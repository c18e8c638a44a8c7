#include "bridges/epuck/accelerometer.hpp"

#include <gtest/gtest.h>

namespace tandem::bridges::epuck {
namespace {

using Verdict = AccelerometerCheck::Verdict;
using Raw = std::array<std::int16_t, 3>;

Raw raw(int left, int ahead, int up) {
  return {static_cast<std::int16_t>(left), static_cast<std::int16_t>(ahead), static_cast<std::int16_t>(up)};
}

// Vectors of the protocol's description: a level robot, and "front lower" on a slope of 30 degrees.
TEST(EpuckAccelerometer, ReadsGravityUpOnALevelRobotOfEachFirmware) {
  for (const auto& [firmware, zero] : {std::pair(Firmware::BTcom, 0), std::pair(Firmware::GCtronic, 2048),
                                       std::pair(Firmware::Webots, 2048), std::pair(Firmware::Epuck2, 2048)}) {
    const auto level = force_m_s2(raw(zero, zero, zero + 800), accelerometer_zero(firmware));
    EXPECT_NEAR(level[0], 0.0, 1e-9);
    EXPECT_NEAR(level[1], 0.0, 1e-9);
    EXPECT_NEAR(level[2], 9.81, 1e-9);
    const auto slope = force_m_s2(raw(zero, zero - 400, zero + 693), accelerometer_zero(firmware));
    EXPECT_NEAR(slope[0], -4.9, 0.01);
    EXPECT_NEAR(slope[1], 0.0, 1e-9);
    EXPECT_NEAR(slope[2], 8.5, 0.01);
  }
}

TEST(EpuckAccelerometer, HasItsFirstAxisToTheLeft) {
  EXPECT_GT(force_m_s2(raw(2148, 2048, 2848), 2048)[1], 0.0);
}

TEST(EpuckAccelerometer, IsBelievedAfterOneGoodReadingAtRest) {
  AccelerometerCheck check;
  check.reset(Firmware::GCtronic);
  EXPECT_EQ(check.verdict(), Verdict::Unchecked);
  check.at_rest(raw(2048, 2048, 2848));
  EXPECT_EQ(check.verdict(), Verdict::Believed);
  EXPECT_NEAR(check.at_rest_m_s2(), 9.81, 1e-9);
}

TEST(EpuckAccelerometer, IsRefusedWhenItDoesNotReadOneGravityAtRest) {
  AccelerometerCheck check;
  check.reset(Firmware::BTcom);
  for (int i = 0; i < 3; ++i) {
    EXPECT_EQ(check.verdict(), Verdict::Unchecked);
    check.at_rest(raw(2048, 2048, 2848));  // another firmware's
  }
  EXPECT_EQ(check.verdict(), Verdict::Refused);
  EXPECT_NEAR(check.at_rest_m_s2(), 49.8, 0.1);
}

TEST(EpuckAccelerometer, KeepsItsVerdictThroughASingleShake) {
  AccelerometerCheck check;
  check.reset(Firmware::Epuck2);
  check.at_rest(raw(2048, 2048, 2848));
  check.at_rest(raw(2048, 2048, 3648));
  check.at_rest(raw(2048, 2048, 2848));
  EXPECT_EQ(check.verdict(), Verdict::Believed);
}

TEST(EpuckAccelerometer, FindsTheZeroOfAnUnknownFirmware) {
  for (const int zero : {0, 2048}) {
    AccelerometerCheck check;
    check.reset(Firmware::Unknown);
    check.at_rest(raw(zero, zero, zero + 800));
    EXPECT_EQ(check.verdict(), Verdict::Believed);
    EXPECT_EQ(check.zero(), zero);
  }
}

}  // namespace
}  // namespace tandem::bridges::epuck
