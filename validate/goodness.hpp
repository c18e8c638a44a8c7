// Tests of samples against distributions: Kolmogorov and Smirnov's, Pearson's chi-square, exact binomial.
#pragma once
#include <cstdint>
#include <functional>
#include <utility>
#include <vector>

namespace tandem::validate {

/// A test statistic, and how likely it or a larger one is when the distribution is the right one.
struct Goodness {
  std::size_t n = 0;
  double statistic = 0.0;
  double p = 1.0;
};

/// Largest distance between the sample's distribution and `cumulative`. p by the limit distribution with the correction
/// of Stephens (1970), good from n = 20 on.
Goodness kolmogorov_smirnov(std::vector<double> sample, const std::function<double(double)>& cumulative);

/// Counts against equal chances.
Goodness chi_square(const std::vector<std::uint64_t>& counts);

/// Two-sided p of k of n events of a chance: twice the smaller tail, at most 1.
double binomial_p(std::uint64_t k, std::uint64_t n, double chance);

/// Exact interval of a chance, of which k of n were seen [Clopper and Pearson 1934].
std::pair<double, double> binomial_interval(std::uint64_t k, std::uint64_t n, double confidence);

double uniform_cumulative(double x, double low, double high);
double normal_cumulative(double x, double sd);
double rayleigh_cumulative(double x, double sigma);

}  // namespace tandem::validate
