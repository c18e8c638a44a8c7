// Elementary functions: near the truth, and the same bits wherever this test runs.
#include "hal/elementary.hpp"

#include <cmath>
#include <cstdint>
#include <cstring>
#include <gtest/gtest.h>
#include <limits>
#include <numbers>

namespace tandem::hal {
namespace {

constexpr double kInfinity = std::numeric_limits<double>::infinity();
constexpr double kNan = std::numeric_limits<double>::quiet_NaN();
constexpr double kPi = std::numbers::pi;

/// Numbers that are spread over what controllers meet: [-half, half], and some close to zero.
class Numbers {
 public:
  std::uint64_t bits() {
    std::uint64_t z = (state_ += 0x9E3779B97F4A7C15U);  // SplitMix64 [Steele, Lea, Flood 2014]
    z = (z ^ (z >> 30U)) * 0xBF58476D1CE4E5B9U;
    z = (z ^ (z >> 27U)) * 0x94D049BB133111EBU;
    return z ^ (z >> 31U);
  }
  double within(double half) {
    const double x = (static_cast<double>(bits() >> 11U) * 0x1p-52 - 1.0) * half;
    return bits() % 16 == 0 ? x * 0x1p-20 : x;
  }

 private:
  std::uint64_t state_ = 1;
};

/// How far `value` is from the C library's, in units in the last place of the latter.
double ulps(double value, double library) {
  const double next = std::nextafter(std::fabs(library), kInfinity);
  return std::fabs(value - library) / (next - std::fabs(library));
}

// The C library's own error is below 1 unit, too.
TEST(Elementary, IsAsNearAsTheCLibrary) {
  Numbers numbers;
  for (int i = 0; i < 50'000; ++i) {
    const double x = numbers.within(10.0);
    ASSERT_LE(ulps(sin(x), std::sin(x)), 1.0) << x;
    ASSERT_LE(ulps(cos(x), std::cos(x)), 1.0) << x;
    ASSERT_LE(ulps(tan(x), std::tan(x)), 3.0) << x;
    const double y = numbers.within(10.0);
    ASSERT_LE(ulps(atan2(y, x), std::atan2(y, x)), 1.0) << y << " " << x;
    ASSERT_LE(ulps(hypot(y, x), std::hypot(y, x)), 1.0) << y << " " << x;
    const double far = numbers.within(1e6);
    ASSERT_LE(ulps(sin(far), std::sin(far)), 1.0) << far;
    ASSERT_LE(ulps(cos(far), std::cos(far)), 1.0) << far;
    const double farther = numbers.within(1e9);
    ASSERT_NEAR(sin(farther), std::sin(farther), 1e-7) << farther;
  }
}

TEST(Elementary, PowersAreAsNearAsTheCLibrary) {
  Numbers numbers;
  for (int i = 0; i < 50'000; ++i) {
    const double x = numbers.within(700.0);
    ASSERT_LE(ulps(exp(x), std::exp(x)), 2.0) << x;
    const double small = numbers.within(2.0);
    ASSERT_LE(ulps(exp(small), std::exp(small)), 2.0) << small;
    const double a = std::fabs(numbers.within(1e3)) + 1e-12;
    ASSERT_LE(ulps(log(a), std::log(a)), 2.0) << a;
    const double b = numbers.within(3.0);
    ASSERT_NEAR(pow(a, b) / std::pow(a, b), 1.0, 1e-14) << a << " " << b;
  }
  EXPECT_EQ(exp(0.0), 1.0);
  EXPECT_EQ(exp(-kInfinity), 0.0);
  EXPECT_EQ(exp(kInfinity), kInfinity);
  EXPECT_EQ(exp(1000.0), kInfinity);
  EXPECT_EQ(exp(-1000.0), 0.0);
  EXPECT_EQ(log(1.0), 0.0);
  EXPECT_EQ(log(0.0), -kInfinity);
  EXPECT_EQ(log(kInfinity), kInfinity);
  EXPECT_EQ(pow(0.0, 2.0), 0.0);
  EXPECT_EQ(pow(0.0, -2.0), kInfinity);
  EXPECT_EQ(pow(5.0, 0.0), 1.0);
  for (const double nan : {exp(kNan), log(kNan), log(-1.0), pow(-1.0, 2.0), pow(kNan, 2.0), pow(2.0, kNan)})
    EXPECT_TRUE(std::isnan(nan));
}

TEST(Elementary, KnowsMultiplesOfAQuarterTurn) {
  for (int n = -1000; n <= 1000; ++n) {
    const double x = n * (0.5 * kPi);
    EXPECT_LE(ulps(sin(x), std::sin(x)), 1.0) << n;
    EXPECT_LE(ulps(cos(x), std::cos(x)), 1.0) << n;
  }
}

TEST(Elementary, KeepsAngleAndLength) {
  Numbers numbers;
  for (int i = 0; i < 10'000; ++i) {
    const double angle = numbers.within(kPi);
    EXPECT_NEAR(atan2(2.0 * sin(angle), 2.0 * cos(angle)), angle, 1e-15);
    EXPECT_NEAR(hypot(sin(angle), cos(angle)), 1.0, 1e-15);
  }
}

TEST(Elementary, TreatsZeroAndInfinityAsTheCLibraryDoes) {
  for (const double y : {0.0, -0.0, 1.0, -1.0, kInfinity, -kInfinity}) {
    for (const double x : {0.0, -0.0, 1.0, -1.0, kInfinity, -kInfinity}) {
      EXPECT_EQ(atan2(y, x), std::atan2(y, x)) << y << " " << x;
      EXPECT_EQ(std::signbit(atan2(y, x)), std::signbit(std::atan2(y, x))) << y << " " << x;
      EXPECT_EQ(hypot(y, x), std::hypot(y, x)) << y << " " << x;
    }
  }
  EXPECT_EQ(sin(0.0), 0.0);
  EXPECT_TRUE(std::signbit(sin(-0.0)));
  EXPECT_TRUE(std::signbit(tan(-0.0)));
  EXPECT_EQ(cos(0.0), 1.0);
  for (const double x : {kInfinity, -kInfinity, kNan}) {
    EXPECT_TRUE(std::isnan(sin(x)));
    EXPECT_TRUE(std::isnan(cos(x)));
    EXPECT_TRUE(std::isnan(tan(x)));
    EXPECT_TRUE(std::isnan(atan2(kNan, x)));
    EXPECT_TRUE(std::isnan(atan2(x, kNan)));
    EXPECT_TRUE(std::isnan(hypot(kNan, x)));
  }
}

TEST(Elementary, NeitherOverflowsNorVanishes) {
  EXPECT_DOUBLE_EQ(hypot(3e300, 4e300), 5e300);
  EXPECT_DOUBLE_EQ(hypot(3e-300, 4e-300), 5e-300);
  EXPECT_DOUBLE_EQ(atan2(1e300, 1e300), 0.25 * kPi);
  EXPECT_DOUBLE_EQ(atan2(1e-310, -1e-310), 0.75 * kPi);
  EXPECT_EQ(atan2(1e-300, 1e300), 0.0);
  EXPECT_DOUBLE_EQ(atan2(1e300, 1e-300), 0.5 * kPi);
}

/// FNV-1a over the bits of what all functions say of a hundred thousand arguments.
TEST(Elementary, HasTheSameBitsOnEveryMachine) {
  Numbers numbers;
  std::uint64_t hash = 14695981039346656037U;
  const auto add = [&hash](double value) {
    std::uint64_t bits = 0;
    std::memcpy(&bits, &value, sizeof bits);
    hash = (hash ^ bits) * 1099511628211U;
  };
  for (int i = 0; i < 100'000; ++i) {
    const double x = numbers.within(10.0);
    const double y = numbers.within(10.0);
    for (const double value : {sin(x), cos(x), tan(x), atan2(y, x), hypot(y, x), sin(1e6 * y), cos(1e8 * x), exp(x),
                               log(std::fabs(y)), pow(std::fabs(x), y)})
      add(value);
  }
  EXPECT_EQ(hash, 17099130538731725789U);
}

}  // namespace
}  // namespace tandem::hal
