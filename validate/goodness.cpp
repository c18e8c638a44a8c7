#include "validate/goodness.hpp"

#include <algorithm>
#include <cmath>

namespace tandem::validate {
namespace {

/// 1 - P(a, x), the upper incomplete gamma function by its series or its continued fraction [Press et al. 2007,
/// section 6.2].
double gamma_q(double a, double x) {
  if (x <= 0.0) return 1.0;
  const double front = std::exp(-x + a * std::log(x) - std::lgamma(a));
  if (x < a + 1.0) {
    double term = 1.0 / a, sum = term;
    for (int n = 1; n < 10'000 && std::abs(term) > 1e-16 * std::abs(sum); ++n) sum += term *= x / (a + n);
    return 1.0 - front * sum;
  }
  double b = x + 1.0 - a, c = 1e300, d = 1.0 / b, h = d;
  for (int n = 1; n < 10'000; ++n) {
    const double an = -n * (n - a);
    b += 2.0;
    d = 1.0 / (an * d + b);
    c = b + an / c;
    const double step = d * c;
    h *= step;
    if (std::abs(step - 1.0) < 1e-15) break;
  }
  return front * h;
}

double log_chance(std::uint64_t k, std::uint64_t n, double p) {
  if (p <= 0.0) return k == 0 ? 0.0 : -INFINITY;
  if (p >= 1.0) return k == n ? 0.0 : -INFINITY;
  const auto kd = static_cast<double>(k), nd = static_cast<double>(n);
  return std::lgamma(nd + 1.0) - std::lgamma(kd + 1.0) - std::lgamma(nd - kd + 1.0) + kd * std::log(p) +
         (nd - kd) * std::log1p(-p);
}

/// Chance of at most k.
double lower_tail(std::uint64_t k, std::uint64_t n, double p) {
  double sum = 0.0;
  for (std::uint64_t i = 0; i <= k; ++i) sum += std::exp(log_chance(i, n, p));
  return std::min(1.0, sum);
}
/// Chance of at least k.
double upper_tail(std::uint64_t k, std::uint64_t n, double p) {
  double sum = 0.0;
  for (std::uint64_t i = k; i <= n; ++i) sum += std::exp(log_chance(i, n, p));
  return std::min(1.0, sum);
}

/// Where a falling function of a chance is `level`.
template <class Falling>
double where(Falling&& f, double level) {
  double low = 0.0, high = 1.0;
  for (int i = 0; i < 100; ++i) {
    const double middle = 0.5 * (low + high);
    (f(middle) > level ? low : high) = middle;
  }
  return 0.5 * (low + high);
}

}  // namespace

Goodness kolmogorov_smirnov(std::vector<double> sample, const std::function<double(double)>& cumulative) {
  std::sort(sample.begin(), sample.end());
  const auto n = static_cast<double>(sample.size());
  double d = 0.0;
  for (std::size_t i = 0; i < sample.size(); ++i) {
    const double f = cumulative(sample[i]);
    d = std::max({d, f - static_cast<double>(i) / n, static_cast<double>(i + 1) / n - f});
  }
  const double lambda = (std::sqrt(n) + 0.12 + 0.11 / std::sqrt(n)) * d;
  double p = 0.0;
  for (int j = 1; j <= 100; ++j) p += (j % 2 == 1 ? 2.0 : -2.0) * std::exp(-2.0 * j * j * lambda * lambda);
  return {sample.size(), d, lambda < 0.2 ? 1.0 : std::clamp(p, 0.0, 1.0)};
}

Goodness chi_square(const std::vector<std::uint64_t>& counts) {
  std::uint64_t n = 0;
  for (const std::uint64_t c : counts) n += c;
  const double expected = static_cast<double>(n) / static_cast<double>(counts.size());
  double sum = 0.0;
  for (const std::uint64_t c : counts)
    sum += (static_cast<double>(c) - expected) * (static_cast<double>(c) - expected) / expected;
  return {n, sum, gamma_q(0.5 * static_cast<double>(counts.size() - 1), 0.5 * sum)};
}

double binomial_p(std::uint64_t k, std::uint64_t n, double chance) {
  return std::min(1.0, 2.0 * std::min(lower_tail(k, n, chance), upper_tail(k, n, chance)));
}

std::pair<double, double> binomial_interval(std::uint64_t k, std::uint64_t n, double confidence) {
  const double tail = 0.5 * (1.0 - confidence);
  const double low = k == 0 ? 0.0 : where([&](double p) { return 1.0 - upper_tail(k, n, p); }, 1.0 - tail);
  const double high = k == n ? 1.0 : where([&](double p) { return lower_tail(k, n, p); }, tail);
  return {low, high};
}

double uniform_cumulative(double x, double low, double high) {
  return std::clamp((x - low) / (high - low), 0.0, 1.0);
}
double normal_cumulative(double x, double sd) {
  return 0.5 * std::erfc(-x / (sd * std::sqrt(2.0)));
}
double rayleigh_cumulative(double x, double sigma) {
  return x <= 0.0 ? 0.0 : -std::expm1(-0.5 * x * x / (sigma * sigma));
}

}  // namespace tandem::validate
