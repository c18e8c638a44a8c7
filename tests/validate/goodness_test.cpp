#include "validate/goodness.hpp"

#include <cmath>
#include <gtest/gtest.h>
#include <random>

namespace tandem::validate {
namespace {

TEST(Goodness, OfCountsIsTheUpperTailOfChiSquare) {
  EXPECT_NEAR(chi_square({10, 20, 30}).p, std::exp(-5.0), 1e-12);  // statistic 10, 2 degrees
  EXPECT_NEAR(chi_square({10, 20, 30}).statistic, 10.0, 1e-12);
  EXPECT_NEAR(chi_square({50, 50, 50, 50}).p, 1.0, 1e-12);
}

TEST(Goodness, OfAnEventIsExact) {
  EXPECT_NEAR(binomial_p(0, 10, 0.5), 2.0 / 1024.0, 1e-12);
  EXPECT_NEAR(binomial_p(5, 10, 0.5), 1.0, 1e-12);
  const auto [low, high] = binomial_interval(0, 10, 0.95);
  EXPECT_EQ(low, 0.0);
  EXPECT_NEAR(high, 1.0 - std::pow(0.025, 0.1), 1e-9);
  const auto [least, most] = binomial_interval(10, 10, 0.95);
  EXPECT_NEAR(least, std::pow(0.025, 0.1), 1e-9);
  EXPECT_EQ(most, 1.0);
}

TEST(Goodness, RejectsAsOftenAsItSays) {
  std::mt19937_64 random(7);
  std::uniform_real_distribution<double> uniform;
  int rejected = 0;
  for (int trial = 0; trial < 1000; ++trial) {
    std::vector<double> sample(200);
    for (double& x : sample) x = uniform(random);
    rejected += kolmogorov_smirnov(sample, [](double x) { return uniform_cumulative(x, 0.0, 1.0); }).p < 0.05 ? 1 : 0;
  }
  EXPECT_GT(binomial_p(static_cast<std::uint64_t>(rejected), 1000, 0.05), 0.001) << rejected;
}

TEST(Goodness, RejectsWhatIsWrong) {
  std::mt19937_64 random(7);
  std::normal_distribution<double> wider(0.0, 1.2);
  std::vector<double> sample(5000);
  for (double& x : sample) x = wider(random);
  EXPECT_LT(kolmogorov_smirnov(sample, [](double x) { return normal_cumulative(x, 1.0); }).p, 1e-3);
  EXPECT_NEAR(rayleigh_cumulative(1.0, 1.0), 1.0 - std::exp(-0.5), 1e-12);
}

}  // namespace
}  // namespace tandem::validate
