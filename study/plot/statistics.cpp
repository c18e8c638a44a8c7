#include "study/plot/statistics.hpp"

#include <algorithm>
#include <cmath>
#include <cstdio>
#include <numeric>

namespace tandem::study {
namespace {

constexpr std::size_t kExactPairs = 2'500;  // up to 50 and 50 values
constexpr std::size_t kExactSigns = 50;

/// The incomplete beta function's continued fraction, by Lentz's method [Press et al. 2007, section 6.4].
double beta_fraction(double a, double b, double x) {
  constexpr double kTiny = 1e-300;
  const auto not_zero = [](double v) { return std::fabs(v) < kTiny ? kTiny : v; };
  double c = 1.0, d = 1.0 / not_zero(1.0 - (a + b) * x / (a + 1.0));
  double result = d;
  for (int i = 1; i <= 500; ++i) {
    const double m = i;
    const double even = m * (b - m) * x / ((a + 2.0 * m - 1.0) * (a + 2.0 * m));
    const double odd = -(a + m) * (a + b + m) * x / ((a + 2.0 * m) * (a + 2.0 * m + 1.0));
    double change = 1.0;
    for (const double term : {even, odd}) {
      d = 1.0 / not_zero(1.0 + term * d);
      c = not_zero(1.0 + term / c);
      change = c * d;
      result *= change;
    }
    if (std::fabs(change - 1.0) < 1e-15) break;
  }
  return result;
}

double incomplete_beta(double a, double b, double x) {
  if (x <= 0.0) return 0.0;
  if (x >= 1.0) return 1.0;
  const double front =
      std::exp(std::lgamma(a + b) - std::lgamma(a) - std::lgamma(b) + a * std::log(x) + b * std::log1p(-x));
  if (x < (a + 1.0) / (a + b + 2.0)) return front * beta_fraction(a, b, x) / a;
  return 1.0 - front * beta_fraction(b, a, 1.0 - x) / b;
}

/// The part of Student's t below `t`.
double student_below(double t, double degrees) {
  const double tail = 0.5 * incomplete_beta(0.5 * degrees, 0.5, degrees / (degrees + t * t));
  return t > 0.0 ? 1.0 - tail : tail;
}

/// Of all arrangements of n and m distinct values, the part in which u is at most `most`.
double exact_part(std::size_t n, std::size_t m, std::size_t most) {
  // ways[i][u]: arrangements in which i of the first sample are among the values looked at so far, with this u.
  std::vector<std::vector<double>> ways(n + 1, std::vector<double>(n * m + 1, 0.0));
  ways[0][0] = 1.0;
  for (std::size_t value = 1; value <= n + m; ++value) {
    for (std::size_t i = std::min(value, n); i >= 1; --i) {
      const std::size_t below = value - i;  // of the second sample, where this value is the i-th of the first
      if (below > m) continue;
      for (std::size_t u = n * m + 1; u-- > below;) ways[i][u] += ways[i - 1][u - below];
    }
  }
  const auto end = ways[n].begin() + static_cast<std::ptrdiff_t>(std::min(most, n * m)) + 1;
  return std::accumulate(ways[n].begin(), end, 0.0) / std::accumulate(ways[n].begin(), ways[n].end(), 0.0);
}

/// P(V <= v) for v = 0, 1, … n (n + 1) / 2, where each of the ranks 1 to n counts or not with equal chances.
std::vector<double> signed_ranks_below(std::size_t n) {
  std::vector<double> ways(n * (n + 1) / 2 + 1, 0.0);
  ways[0] = 1.0;
  std::size_t most = 0;
  for (std::size_t rank = 1; rank <= n; ++rank) {
    for (std::size_t v = most + 1; v-- > 0;) ways[v + rank] += ways[v];
    most += rank;
  }
  std::partial_sum(ways.begin(), ways.end(), ways.begin());
  for (double& part : ways) part = std::ldexp(part, -static_cast<int>(n));
  return ways;
}

/// Rank of each value, from 1; equal ones share theirs. Adds t^3 - t for each t of them to `ties`.
std::vector<double> ranks_of(const std::vector<double>& values, double& ties) {
  std::vector<std::size_t> order(values.size());
  std::iota(order.begin(), order.end(), std::size_t{0});
  std::sort(order.begin(), order.end(), [&](std::size_t a, std::size_t b) { return values[a] < values[b]; });
  std::vector<double> ranks(values.size());
  for (std::size_t i = 0; i < order.size();) {
    std::size_t end = i;
    while (end < order.size() && !(values[order[i]] < values[order[end]])) ++end;
    const auto same = static_cast<double>(end - i);
    ties += same * same * same - same;
    const double rank = 0.5 * static_cast<double>(i + 1 + end);
    for (; i < end; ++i) ranks[order[i]] = rank;
  }
  return ranks;
}

/// The means of any two of n values, each with itself, too; in order, but never laid out: there are n (n + 1) / 2.
class MeansOfTwo {
 public:
  /// `sorted` must outlive this, and has one value at least.
  explicit MeansOfTwo(const std::vector<double>& sorted) : sorted_(sorted) {}
  std::size_t size() const { return sorted_.size() * (sorted_.size() + 1) / 2; }
  /// The one that has `index` before it, to within a rounding.
  double at(std::size_t index) const {
    double low = sorted_.front(), high = sorted_.back();
    if (up_to(low) > index) return low;
    const double enough = 1e-12 * (high - low);
    while (high - low > enough) {
      const double middle = low + 0.5 * (high - low);
      if (middle <= low || middle >= high) break;
      (up_to(middle) > index ? high : low) = middle;
    }
    return next_above(low);
  }
  double median() const { return 0.5 * (at((size() - 1) / 2) + at(size() / 2)); }

 private:
  static double mean(double a, double b) { return 0.5 * a + 0.5 * b; }
  /// How many of them are not above `most`.
  std::size_t up_to(double most) const {
    std::size_t count = 0, end = sorted_.size();  // those before `end` fit
    for (std::size_t i = 0; i < sorted_.size(); ++i) {
      while (end > i && mean(sorted_[i], sorted_[end - 1]) > most) --end;
      if (end <= i) break;
      count += end - i;
    }
    return count;
  }
  /// The least of them that is above `below`.
  double next_above(double below) const {
    double least = sorted_.back();
    std::size_t end = sorted_.size();
    for (std::size_t i = 0; i < sorted_.size(); ++i) {
      while (end > i && mean(sorted_[i], sorted_[end - 1]) > below) --end;
      const std::size_t first = std::max(i, end);
      if (first < sorted_.size()) least = std::min(least, mean(sorted_[i], sorted_[first]));
    }
    return least;
  }
  const std::vector<double>& sorted_;
};

/// Signed ranks of n pairs: those sums up to this one are the least likely 2.5 %, or fewer; -1: there are none.
std::ptrdiff_t least_likely(std::size_t n) {
  if (n <= kExactSigns) {
    const std::vector<double> below = signed_ranks_below(n);
    return std::lower_bound(below.begin(), below.end(), 0.025) - below.begin() - 1;
  }
  const auto pairs = static_cast<double>(n);
  const double spread = std::sqrt(pairs * (pairs + 1.0) * (2.0 * pairs + 1.0) / 24.0);
  return static_cast<std::ptrdiff_t>(std::floor(pairs * (pairs + 1.0) / 4.0 - 1.959963985 * spread));
}

std::string number(double value, int digits) {
  char text[40];
  const int n = std::snprintf(text, sizeof text, "%.*g", digits, value);
  return {text, static_cast<std::size_t>(n)};
}

std::string p_text(double p, bool exact) {
  return (p < 1e-4 ? "p < 0.0001" : "p = " + number(p, 2)) + (exact ? " (exact)" : "");
}

}  // namespace

double quantile(const std::vector<double>& sorted, double part) {
  const double at = part * static_cast<double>(sorted.size() - 1);
  const auto below = static_cast<std::size_t>(at);
  const std::size_t above = std::min(below + 1, sorted.size() - 1);
  return sorted[below] + (at - static_cast<double>(below)) * (sorted[above] - sorted[below]);
}

Summary median_and_quartiles(std::vector<double> values) {
  if (values.empty()) return {};
  std::sort(values.begin(), values.end());
  return {values.size(), quantile(values, 0.5), quantile(values, 0.25), quantile(values, 0.75)};
}

Summary mean_and_confidence(const std::vector<double>& values) {
  if (values.empty()) return {};
  const auto n = static_cast<double>(values.size());
  const double mean = std::accumulate(values.begin(), values.end(), 0.0) / n;
  if (values.size() == 1) return {1, mean, mean, mean};
  double squares = 0.0;
  for (const double v : values) squares += (v - mean) * (v - mean);
  const double half = student_quantile(0.975, n - 1.0) * std::sqrt(squares / (n - 1.0) / n);
  return {values.size(), mean, mean - half, mean + half};
}

Box box_of(std::vector<double> values) {
  Box box;
  box.box = median_and_quartiles(values);
  const double reach = 1.5 * (box.box.high - box.box.low);
  box.whisker_low = box.box.low;
  box.whisker_high = box.box.high;
  std::sort(values.begin(), values.end());
  for (const double v : values) {
    if (v < box.box.low - reach || v > box.box.high + reach) {
      box.outliers.push_back(v);
      continue;
    }
    box.whisker_low = std::min(box.whisker_low, v);
    box.whisker_high = std::max(box.whisker_high, v);
  }
  return box;
}

double student_quantile(double part, double degrees) {
  if (part < 0.5) return -student_quantile(1.0 - part, degrees);
  double low = 0.0, high = 1.0;
  while (student_below(high, degrees) < part && high < 1e12) high *= 2.0;
  for (int i = 0; i < 200 && high - low > 1e-13 * high; ++i) {
    const double middle = 0.5 * (low + high);
    (student_below(middle, degrees) < part ? low : high) = middle;
  }
  return 0.5 * (low + high);
}

Difference mann_whitney(const std::vector<double>& a, const std::vector<double>& b) {
  Difference d;
  d.n_a = a.size();
  d.n_b = b.size();
  d.median_a = median_and_quartiles(a).centre;
  d.median_b = median_and_quartiles(b).centre;
  const double pairs = static_cast<double>(d.n_a) * static_cast<double>(d.n_b);
  std::vector<double> all = a;
  all.insert(all.end(), b.begin(), b.end());
  double ties = 0.0;
  const std::vector<double> ranks = ranks_of(all, ties);
  d.u = std::accumulate(ranks.begin(), ranks.begin() + static_cast<std::ptrdiff_t>(a.size()), 0.0) -
        0.5 * static_cast<double>(d.n_a) * static_cast<double>(d.n_a + 1);
  d.a_larger = d.u / pairs;
  d.exact = !(ties > 0.0) && d.n_a * d.n_b <= kExactPairs;
  if (d.exact) {
    d.p = std::min(1.0, 2.0 * exact_part(d.n_a, d.n_b, static_cast<std::size_t>(std::min(d.u, pairs - d.u))));
    return d;
  }
  const auto n = static_cast<double>(all.size());
  const double variance = pairs / 12.0 * (n + 1.0 - ties / (n * (n - 1.0)));
  const double distance = std::max(0.0, std::fabs(d.u - 0.5 * pairs) - 0.5);
  d.p = variance > 1e-9 ? std::min(1.0, std::erfc(distance / std::sqrt(2.0 * variance))) : 1.0;
  return d;
}

std::vector<AmongTests> holm(const std::vector<double>& p) {
  std::vector<std::size_t> order(p.size());
  std::iota(order.begin(), order.end(), std::size_t{0});
  std::stable_sort(order.begin(), order.end(), [&](std::size_t a, std::size_t b) { return p[a] < p[b]; });
  std::vector<AmongTests> all(p.size());
  double least = 0.0;
  for (std::size_t rank = 0; rank < order.size(); ++rank) {
    least = std::max(least, std::min(1.0, static_cast<double>(p.size() - rank) * p[order[rank]]));
    all[order[rank]] = {p.size(), least};
  }
  return all;
}

namespace {

/// That a test is judged by, which alone has `p`.
double judged_by(const AmongTests& among, double p) {
  return among.count < 2 ? p : among.p;
}

/// Nothing of a test that is read alone.
std::string text_of(const AmongTests& among) {
  if (among.count < 2) return "";
  return ", among " + std::to_string(among.count) + " tests " + p_text(among.p, false) + " (Holm)";
}

}  // namespace

std::string in_words(const Difference& d, const std::string& a, const std::string& b, const AmongTests& among) {
  const std::string samples = a + " (median " + number(d.median_a, 4) + ", n = " + std::to_string(d.n_a) + ") and " +
                              b + " (median " + number(d.median_b, 4) + ", n = " + std::to_string(d.n_b) + ")";
  const double effect = std::fabs(d.a_larger - 0.5);  // thresholds of Vargha and Delaney [2000]
  const std::string size = effect >= 0.21   ? "large"
                           : effect >= 0.14 ? "medium"
                           : effect >= 0.06 ? "small"
                                            : "negligible";
  const std::string test = "Mann-Whitney U = " + number(d.u, 6) + ", " + p_text(d.p, d.exact) +
                           ", effect size A = " + number(d.a_larger, 2) + " (" + size + ")" + text_of(among);
  if (judged_by(among, d.p) >= 0.05) return "no difference shows between " + samples + ": " + test;
  const bool more = d.a_larger > 0.5;
  return samples + " differ, " + (more ? a : b) + " is larger in " +
         number(100.0 * std::max(d.a_larger, 1.0 - d.a_larger), 3) + " % of pairs of runs: " + test;
}

Summary shift_of_pairs(std::vector<double> differences) {
  if (differences.empty()) return {};
  std::sort(differences.begin(), differences.end());
  const MeansOfTwo means(differences);
  const auto cut = static_cast<std::size_t>(std::max<std::ptrdiff_t>(0, least_likely(differences.size())));
  return {differences.size(), means.median(), means.at(cut), means.at(means.size() - 1 - cut)};
}

PairedDifference signed_rank(const std::vector<double>& differences) {
  PairedDifference d;
  d.n = differences.size();
  d.shift = shift_of_pairs(differences);
  std::vector<double> sizes;
  std::vector<bool> positive;
  for (const double difference : differences) {
    if (difference > 0.0 || difference < 0.0) {
      sizes.push_back(std::fabs(difference));
      positive.push_back(difference > 0.0);
      ++(difference > 0.0 ? d.a_larger : d.b_larger);
    }
  }
  if (sizes.empty()) return d;
  double ties = 0.0;
  const std::vector<double> ranks = ranks_of(sizes, ties);
  for (std::size_t i = 0; i < ranks.size(); ++i) d.v += positive[i] ? ranks[i] : 0.0;
  const auto n = static_cast<double>(sizes.size());
  d.exact = !(ties > 0.0) && sizes.size() == differences.size() && sizes.size() <= kExactSigns;
  if (d.exact) {
    const double less = std::min(d.v, n * (n + 1.0) / 2.0 - d.v);
    d.p = std::min(1.0, 2.0 * signed_ranks_below(sizes.size())[static_cast<std::size_t>(less)]);
    return d;
  }
  const double variance = n * (n + 1.0) * (2.0 * n + 1.0) / 24.0 - ties / 48.0;
  const double distance = std::max(0.0, std::fabs(d.v - n * (n + 1.0) / 4.0) - 0.5);
  d.p = std::min(1.0, std::erfc(distance / std::sqrt(2.0 * variance)));
  return d;
}

std::string in_words(const PairedDifference& d, const std::string& a, const std::string& b, const AmongTests& among) {
  const std::string pairs = std::to_string(d.n) + (d.n == 1 ? " matched pair" : " matched pairs");
  const std::string found = a + " - " + b + " is " + number(d.shift.centre, 4) + " (" + (d.n < 6 ? "from " : "95 %: ") +
                            number(d.shift.low, 4) + " to " + number(d.shift.high, 4) + "), " + a + " is larger in " +
                            std::to_string(d.a_larger) + " and smaller in " + std::to_string(d.b_larger) +
                            ": Wilcoxon signed-rank V = " + number(d.v, 6) + ", " + p_text(d.p, d.exact) +
                            text_of(among);
  if (judged_by(among, d.p) >= 0.05)
    return "no difference shows between " + a + " and " + b + " in " + pairs + ", " + found;
  return a + " and " + b + " differ in " + pairs + ", " + found;
}

Correlation spearman(const std::vector<double>& x, const std::vector<double>& y) {
  Correlation c;
  c.n = x.size();
  double ties = 0.0;
  const std::vector<double> a = ranks_of(x, ties), b = ranks_of(y, ties);
  const auto n = static_cast<double>(c.n);
  const double middle = 0.5 * (n + 1.0);
  double both = 0.0, of_a = 0.0, of_b = 0.0;
  for (std::size_t i = 0; i < c.n; ++i) {
    both += (a[i] - middle) * (b[i] - middle);
    of_a += (a[i] - middle) * (a[i] - middle);
    of_b += (b[i] - middle) * (b[i] - middle);
  }
  c.rho = both / std::sqrt(of_a * of_b);  // NaN where one of them has no spread
  if (c.n < 3 || std::isnan(c.rho)) return c;
  c.p = incomplete_beta(0.5 * (n - 2.0), 0.5,
                        std::max(0.0, 1.0 - c.rho * c.rho));  // of t^2 = rho^2 (n - 2) / (1 - rho^2)
  return c;
}

std::string in_words(const Correlation& c, const std::string& x, const std::string& y, const AmongTests& among) {
  const std::string what = y + " and " + x + " in " + std::to_string(c.n) + " runs";
  if (std::isnan(c.rho)) return what + ": one of them is the same in all";
  return what +
         (judged_by(among, c.p) < 0.05 ? (c.rho > 0.0 ? " rise together" : " go against each other")
                                       : " show no connection") +
         ": Spearman rho = " + number(c.rho, 2) + ", " + p_text(c.p, false) + text_of(among);
}

}  // namespace tandem::study
