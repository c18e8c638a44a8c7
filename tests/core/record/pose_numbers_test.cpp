#include "core/record/pose_numbers.hpp"

#include <array>
#include <cmath>
#include <gtest/gtest.h>
#include <limits>
#include <vector>

namespace tandem::core {
namespace {

TEST(PoseNumbers, AreTheNearestMicrometre) {
  const std::vector<double> metres = {0.0, 1e-6, -1e-6, 1.4e-6, -1.6e-6, -31.4159266, 2147.483647, -2147.483647, 0.25};
  std::vector<std::int32_t> numbers(metres.size());
  to_micrometres(metres, numbers);
  EXPECT_EQ(numbers, (std::vector<std::int32_t>{0, 1, -1, 1, -2, -31415927, 2147483647, -2147483647, 250000}));
}

TEST(PoseNumbers, SayWhatDoesNotFitOrIsNone) {
  const std::vector<double> metres = {2147.5, -3000.0, std::numeric_limits<double>::infinity(),
                                      std::numeric_limits<double>::quiet_NaN(), 1.0};
  std::vector<std::int32_t> numbers(metres.size());
  to_micrometres(metres, numbers);
  EXPECT_EQ(numbers, (std::vector<std::int32_t>{kNoNumber, kNoNumber, kNoNumber, kNoNumber, 1000000}));
}

TEST(PoseNumbers, AreTheNearestAngle) {
  constexpr int kAngles = 100'003;
  std::vector<double> c, s, length;
  for (int i = 0; i < kAngles; ++i) {
    const double angle = -std::numbers::pi + 2.0 * std::numbers::pi * i / kAngles;
    const double r = 0.5 + (i % 7);
    c.push_back(r * std::cos(angle));
    s.push_back(r * std::sin(angle));
  }
  std::vector<std::int32_t> numbers(c.size());
  to_binary_angles(c, s, numbers);
  for (std::size_t i = 1; i < c.size(); ++i)
    ASSERT_NEAR(numbers[i] * kBinaryAngle, std::atan2(s[i], c[i]), 0.52 * kBinaryAngle) << i;
}

TEST(PoseNumbers, KnowHalfATurnAndEveryQuarter) {
  const std::array<double, 6> c = {1.0, 0.0, -1.0, 0.0, 0.0, std::numeric_limits<double>::quiet_NaN()};
  const std::array<double, 6> s = {0.0, 1.0, 0.0, -1.0, 0.0, 1.0};
  std::array<std::int32_t, 6> numbers{};
  to_binary_angles(c, s, numbers);
  EXPECT_EQ(numbers, (std::array<std::int32_t, 6>{0, 1 << 30, 2147483647, -(1 << 30), 0, kNoNumber}));
}

}  // namespace
}  // namespace tandem::core
