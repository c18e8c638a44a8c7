// Statistics of samples: what lies in the middle, how far it spreads, whether two differ.
#pragma once
#include <cstddef>
#include <string>
#include <vector>

namespace tandem::study {

/// The middle of a sample, and what lies around it.
struct Summary {
  std::size_t n = 0;
  double centre = 0.0;
  double low = 0.0, high = 0.0;
};

/// Quantile by linear interpolation between the two nearest values, as R's type 7. `sorted` has one value at least.
double quantile(const std::vector<double>& sorted, double part);

/// Median, lower and upper quartile.
Summary median_and_quartiles(std::vector<double> values);
/// Mean and its 95 % confidence interval by Student's t; of one value alone it has no width.
Summary mean_and_confidence(const std::vector<double>& values);

/// What a box plot shows: whiskers reach the farthest values within 1.5 times the height of the box [Tukey 1977].
struct Box {
  Summary box;  ///< median and quartiles
  double whisker_low = 0.0, whisker_high = 0.0;
  std::vector<double> outliers;
};
Box box_of(std::vector<double> values);

/// Quantile of Student's t with `degrees` of freedom, 1 at least; `part` in (0, 1).
double student_quantile(double part, double degrees);

/// What a test says among several that are read together: `p` is how probable a result as clear as this is anywhere
/// among them when there is nothing to find.
struct AmongTests {
  std::size_t count = 1;  ///< of the tests; 1: it is read alone
  double p = 1.0;
};

/// For tests with these p, by the step-down method of Holm [1979], in the same order.
std::vector<AmongTests> holm(const std::vector<double>& p);

/// Whether two samples differ: the test of Mann and Whitney.
struct Difference {
  std::size_t n_a = 0, n_b = 0;
  double median_a = 0.0, median_b = 0.0;
  double u = 0.0;      ///< pairs in which the value of A is larger; ties count half
  double p = 1.0;      ///< two-sided
  bool exact = false;  ///< p of all arrangements; else by the normal approximation with ties and continuity corrected
  double a_larger = 0.5;  ///< effect size A of Vargha and Delaney [2000]: u by the number of pairs
};
/// Both have one value at least.
Difference mann_whitney(const std::vector<double>& a, const std::vector<double>& b);

/// The difference in a sentence; whether there is one is judged among all tests that it is read with.
std::string in_words(const Difference& d, const std::string& a, const std::string& b, const AmongTests& among = {});

/// How much larger the one of a pair is: the estimate of Hodges and Lehmann, the median of the means of any two
/// differences (each with itself, too), with the 95 % confidence interval that Wilcoxon's signed ranks give it
/// [Hollander and Wolfe 1999, sections 3.2 and 3.3]. Of fewer than 6 pairs there is no such interval: low and high are
/// then the least and the largest difference.
Summary shift_of_pairs(std::vector<double> differences);

/// Whether one of a pair is larger than the other: Wilcoxon's signed-rank test of their differences A - B. Pairs
/// without a difference are left out of ranks and test, and counted in `n`.
struct PairedDifference {
  std::size_t n = 0;
  std::size_t a_larger = 0, b_larger = 0;  ///< pairs
  Summary shift;                           ///< of A over B
  double v = 0.0;                          ///< sum of the ranks of pairs in which A is larger
  double p = 1.0;                          ///< two-sided
  bool exact = false;  ///< p of all 2^n signs; else by the normal approximation with ties and continuity corrected
};
PairedDifference signed_rank(const std::vector<double>& differences);
std::string in_words(const PairedDifference& d, const std::string& a, const std::string& b,
                     const AmongTests& among = {});

/// Whether two measures of the same runs rise and fall together: Spearman's rank correlation.
struct Correlation {
  std::size_t n = 0;
  double rho = 0.0;  ///< NaN: one of them is the same in all runs
  double p = 1.0;    ///< two-sided, by Student's t with n - 2 degrees of freedom
};
Correlation spearman(const std::vector<double>& x, const std::vector<double>& y);
std::string in_words(const Correlation& c, const std::string& x, const std::string& y, const AmongTests& among = {});

}  // namespace tandem::study
