#include "hal/random.hpp"

#include <algorithm>
#include <cmath>
#include <gtest/gtest.h>
#include <map>
#include <numeric>
#include <set>

#include "hal/philox.hpp"

namespace tandem::hal {
namespace {

TEST(Philox, IsAsPublished) {
  // Known answers of Philox4x32-10 [Random123, kat_vectors].
  const std::array<std::uint32_t, 4> zeros{0x6627e8d5U, 0xe169c58dU, 0xbc57ac4cU, 0x9b00dbd8U};
  EXPECT_EQ(philox({0, 0, 0, 0}, 0), zeros);
  const std::uint32_t all = 0xffffffffU;
  const std::array<std::uint32_t, 4> ones{0x408f276dU, 0x41c83b0eU, 0xa20bc7c6U, 0x6d5451fdU};
  EXPECT_EQ(philox({all, all, all, all}, 0xffffffffffffffffU), ones);
}

TEST(Random, IsTheSameOnEveryMachine) {
  Random random(seed_of(7, "ep3"));
  std::uint64_t hash = 0;
  for (int i = 0; i < 1000; ++i) hash = hash * 31 + random();
  for (int i = 0; i < 1000; ++i)
    hash = hash * 31 + static_cast<std::uint64_t>(static_cast<std::int64_t>(random.normal() * 0x1p40));
  for (int i = 0; i < 1000; ++i)
    hash = hash * 31 + static_cast<std::uint64_t>(static_cast<std::int64_t>(random.exponential() * 0x1p40));
  EXPECT_EQ(hash, 12375695099442348091U);
}

TEST(Random, FollowsItsSeedItsNameAndItsStream) {
  const auto first = [](Random random) { return random(); };
  const std::uint64_t base = first(Random(seed_of(1, "ep0")));
  EXPECT_EQ(first(Random(seed_of(1, "ep0"))), base);
  EXPECT_NE(first(Random(seed_of(2, "ep0"))), base);
  EXPECT_NE(first(Random(seed_of(1, "ep1"))), base);
  EXPECT_NE(first(Random(seed_of(1, "ep0"), 1)), base);
}

TEST(Random, ACopyGoesOnAsTheOriginal) {
  Random random(5);
  (void)random();
  Random copy = random;
  for (int i = 0; i < 10; ++i) EXPECT_EQ(copy(), random());
}

TEST(Random, NumbersHaveTheirMoments) {
  constexpr int kDraws = 100000;
  Random random(9);
  double uniform = 0.0, normal = 0.0, square = 0.0, wait = 0.0;
  int yes = 0;
  for (int i = 0; i < kDraws; ++i) {
    const double u = random.uniform(2.0, 4.0);
    ASSERT_TRUE(u >= 2.0 && u < 4.0);
    uniform += u;
    const double n = random.normal(1.0, 2.0);
    normal += n;
    square += (n - 1.0) * (n - 1.0);
    wait += random.exponential(3.0);
    yes += random.chance(0.3) ? 1 : 0;
  }
  // Within five standard errors.
  EXPECT_NEAR(uniform / kDraws, 3.0, 5 * 0.577 / std::sqrt(kDraws));
  EXPECT_NEAR(normal / kDraws, 1.0, 5 * 2.0 / std::sqrt(kDraws));
  EXPECT_NEAR(square / kDraws, 4.0, 5 * 4.0 * std::sqrt(2.0 / kDraws));
  EXPECT_NEAR(wait / kDraws, 3.0, 5 * 3.0 / std::sqrt(kDraws));
  EXPECT_NEAR(static_cast<double>(yes) / kDraws, 0.3, 5 * std::sqrt(0.21 / kDraws));
}

TEST(Random, ChancesOfNothingAndOfAllAreSure) {
  Random random(3);
  for (int i = 0; i < 1000; ++i) {
    EXPECT_FALSE(random.chance(0.0));
    EXPECT_TRUE(random.chance(1.0));
  }
}

TEST(Random, IntegersAreEquallyLikelyAndKeepTheirBounds) {
  Random random(11);
  std::map<std::int64_t, int> counts;
  for (int i = 0; i < 60000; ++i) ++counts[random.integer(-2, 3)];
  ASSERT_EQ(counts.size(), 6U);
  for (const auto& [value, count] : counts) EXPECT_NEAR(count, 10000, 5 * std::sqrt(60000.0 * 5 / 36)) << value;
  EXPECT_EQ(random.integer(4, 4), 4);
  EXPECT_EQ(random.integer(4, 2), 4);
  constexpr auto kMost = std::numeric_limits<std::int64_t>::max();
  constexpr auto kLeast = std::numeric_limits<std::int64_t>::min();
  bool negative = false, positive = false;
  for (int i = 0; i < 100; ++i) {
    const std::int64_t any = random.integer(kLeast, kMost);
    negative = negative || any < 0;
    positive = positive || any > 0;
  }
  EXPECT_TRUE(negative && positive);
}

TEST(Random, AllOrdersOfAShuffleAreEquallyLikely) {
  Random random(13);
  std::map<std::array<int, 3>, int> counts;
  for (int i = 0; i < 12000; ++i) {
    std::array<int, 3> values{1, 2, 3};
    random.shuffle(values);
    ++counts[values];
  }
  ASSERT_EQ(counts.size(), 6U);
  for (const auto& [order, count] : counts) EXPECT_NEAR(count, 2000, 5 * std::sqrt(12000.0 * 5 / 36));
  std::vector<int> none;
  random.shuffle(none);
}

}  // namespace
}  // namespace tandem::hal
