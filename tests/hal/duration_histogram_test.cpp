#include "hal/duration_histogram.hpp"

#include <algorithm>
#include <gtest/gtest.h>
#include <limits>
#include <random>
#include <vector>

namespace tandem::hal {
namespace {

TEST(DurationHistogram, IsExactForSmallDurations) {
  DurationHistogram h;
  for (int i = 0; i <= 30; ++i) h.add(i);
  EXPECT_EQ(h.quantile_ns(0.0), 0);
  EXPECT_EQ(h.quantile_ns(0.5), 15);
  EXPECT_EQ(h.quantile_ns(1.0), 30);
}

TEST(DurationHistogram, QuantilesAreAtMostOneSixteenthTooLarge) {
  std::mt19937_64 random(7);
  std::lognormal_distribution<double> durations(12.0, 3.0);
  DurationHistogram h;
  std::vector<TimeNs> all;
  for (int i = 0; i < 20'000; ++i) {
    all.push_back(static_cast<TimeNs>(durations(random)));
    h.add(all.back());
  }
  std::sort(all.begin(), all.end());
  for (const double q : {0.01, 0.25, 0.5, 0.9, 0.99, 0.999}) {
    const auto exact = static_cast<double>(all[static_cast<std::size_t>(q * 20'000.0) - 1]);
    const auto told = static_cast<double>(h.quantile_ns(q));
    EXPECT_GE(told, exact) << q;
    EXPECT_LE(told, exact * (1.0 + 1.0 / 16.0) + 1.0) << q;
  }
  EXPECT_EQ(h.quantile_ns(1.0), all.back());
  EXPECT_EQ(h.largest_ns(), all.back());
}

TEST(DurationHistogram, HoldsTheLargestDurationThereIsAndCountsNegativeOnesAsNothing) {
  DurationHistogram h;
  h.add(-5);
  EXPECT_EQ(h.quantile_ns(1.0), 0);
  h.add(std::numeric_limits<TimeNs>::max());
  EXPECT_EQ(h.count(), 2U);
  EXPECT_EQ(h.quantile_ns(1.0), std::numeric_limits<TimeNs>::max());
}

TEST(DurationHistogram, TakesInWhatAnotherHasCounted) {
  DurationHistogram a, b;
  for (int i = 0; i < 10; ++i) a.add(i);
  for (int i = 10; i < 20; ++i) b.add(i);
  a.add(b);
  EXPECT_EQ(a.count(), 20U);
  EXPECT_EQ(a.quantile_ns(0.5), 9);
  EXPECT_EQ(a.largest_ns(), 19);
}

TEST(DurationHistogram, AnEmptyOneSaysZero) {
  EXPECT_EQ(DurationHistogram{}.quantile_ns(0.99), 0);
}

}  // namespace
}  // namespace tandem::hal
