// Statistics against published values, and charts of small samples.
#include "study/plot/statistics.hpp"

#include <cmath>
#include <gmock/gmock.h>
#include <gtest/gtest.h>
#include <rapidcheck.h>

#include "study/plot/chart.hpp"

namespace tandem::study {
namespace {

using testing::HasSubstr;

TEST(Statistics, KnowsStudentsQuantilesFromTables) {
  for (const auto& [degrees, t] :
       {std::pair(1.0, 12.7062), {2.0, 4.3027}, {5.0, 2.5706}, {9.0, 2.2622}, {29.0, 2.0452}})
    EXPECT_NEAR(student_quantile(0.975, degrees), t, 1e-4);
  EXPECT_NEAR(student_quantile(0.975, 1e7), 1.959964, 1e-5);
  EXPECT_NEAR(student_quantile(0.025, 5.0), -2.5706, 1e-4);
}

TEST(Statistics, OfAMeanAreThoseOfPaperAndPencil) {
  const Summary s = mean_and_confidence({1.0, 2.0, 3.0, 4.0});
  EXPECT_DOUBLE_EQ(s.centre, 2.5);
  EXPECT_NEAR(s.high - s.centre, 3.18245 * std::sqrt(5.0 / 3.0 / 4.0), 1e-4);
  const Summary one = mean_and_confidence({7.0});
  EXPECT_EQ(one.low, 7.0);
  EXPECT_EQ(one.high, 7.0);
}

TEST(Statistics, TakesQuartilesAsRDoes) {
  const Summary s = median_and_quartiles({7.0, 1.0, 3.0, 2.0});  // quantile(c(7,1,3,2)): 1.75, 2.5, 4
  EXPECT_DOUBLE_EQ(s.low, 1.75);
  EXPECT_DOUBLE_EQ(s.centre, 2.5);
  EXPECT_DOUBLE_EQ(s.high, 4.0);
  const Box b = box_of({1, 2, 3, 4, 5, 100});
  EXPECT_EQ(b.outliers, std::vector<double>{100});
  EXPECT_EQ(b.whisker_high, 5.0);
  EXPECT_EQ(b.whisker_low, 1.0);
}

TEST(MannWhitney, GivesExactPartsOfSmallSamples) {
  // Of the 20 arrangements of 3 and 3, one has u = 0: p = 2 / 20.
  const Difference d = mann_whitney({1, 2, 3}, {4, 5, 6});
  EXPECT_TRUE(d.exact);
  EXPECT_EQ(d.u, 0.0);
  EXPECT_DOUBLE_EQ(d.p, 0.1);
  EXPECT_EQ(d.a_larger, 0.0);
  // wilcox.test(c(0.80,0.83,1.89,1.04,1.45,1.38,1.91,1.64,0.73,1.46), c(1.15,0.88,0.90,0.74,1.21)): W = 35, p = 0.2544
  const Difference r =
      mann_whitney({0.80, 0.83, 1.89, 1.04, 1.45, 1.38, 1.91, 1.64, 0.73, 1.46}, {1.15, 0.88, 0.90, 0.74, 1.21});
  EXPECT_EQ(r.u, 35.0);
  EXPECT_NEAR(r.p, 0.2544, 5e-5);
}

TEST(MannWhitney, TreatsTiesByTheNormalApproximation) {
  // Three 2 and two 3: variance 25 / 12 * (11 - 30 / 90) = 22.22, z = 7.5 / 4.714 = 1.591.
  const Difference d = mann_whitney({1, 2, 2, 3, 4}, {2, 3, 5, 6, 7});
  EXPECT_FALSE(d.exact);
  EXPECT_EQ(d.u, 4.5);
  EXPECT_NEAR(d.p, 0.11161, 1e-5);
  EXPECT_EQ(mann_whitney({1, 1}, {1, 1}).p, 1.0);
}

TEST(MannWhitney, IsTheSameFromBothSidesAndCountsPairs) {
  EXPECT_TRUE(rc::check([] {
    const auto sample = [] {
      std::vector<double> v;
      for (const int n : *rc::gen::nonEmpty(rc::gen::container<std::vector<int>>(rc::gen::inRange(0, 30))))
        v.push_back(n);
      return v;
    };
    const std::vector<double> a = sample(), b = sample();
    const Difference ab = mann_whitney(a, b), ba = mann_whitney(b, a);
    double u = 0.0;
    for (const double x : a) {
      for (const double y : b) u += x > y ? 1.0 : x < y ? 0.0 : 0.5;
    }
    RC_ASSERT(std::fabs(ab.u - u) < 1e-9);
    RC_ASSERT(std::fabs(ab.p - ba.p) < 1e-9);
    RC_ASSERT(std::fabs(ab.a_larger + ba.a_larger - 1.0) < 1e-12);
    RC_ASSERT(ab.p >= 0.0 && ab.p <= 1.0);
  }));
}

TEST(MannWhitney, IsToldInWords) {
  EXPECT_EQ(in_words(mann_whitney({4, 5, 6, 7, 8}, {1, 2, 3, 0, -1}), "ideal", "noise"),
            "ideal (median 6, n = 5) and noise (median 1, n = 5) differ, ideal is larger in 100 % of pairs of runs: "
            "Mann-Whitney U = 25, p = 0.0079 (exact), effect size A = 1 (large)");
  EXPECT_THAT(in_words(mann_whitney({1, 4}, {2, 3}), "a", "b"), HasSubstr("no difference shows between a"));
}

std::vector<Observation> observations() {
  std::vector<Observation> all;
  for (const char* group : {"ideal", "noise"}) {
    for (const char* x : {"1 m", "10 m", "2 m"}) {
      for (int i = 0; i < 4; ++i) all.push_back({"", group, x, i + (group[0] == 'i' ? 10.0 : 0.0)});
    }
  }
  return all;
}

TEST(SignedRank, GivesTheIntervalOfTheTables) {
  // The 9th, the middle and the 47th of 55 means: 8 is the critical value of ten pairs at 5 % [Hollander and Wolfe
  // 1999, table A.4].
  const std::vector<double> d = {1, 2, 4, 8, 16, 32, 64, 128, 256, 512};
  std::vector<double> means;
  for (std::size_t i = 0; i < d.size(); ++i) {
    for (std::size_t k = i; k < d.size(); ++k) means.push_back(0.5 * (d[i] + d[k]));
  }
  std::sort(means.begin(), means.end());
  const Summary s = shift_of_pairs(d);
  EXPECT_EQ(s.low, means[8]);
  EXPECT_EQ(s.centre, means[27]);
  EXPECT_EQ(s.high, means[46]);
  const Summary few = shift_of_pairs({3, 1, 2});
  EXPECT_EQ(few.low, 1.0);
  EXPECT_EQ(few.high, 3.0);
}

TEST(SignedRank, GivesWhatPublishedExamplesGive) {
  // Depression scales of nine patients [Hollander and Wolfe 1973, p. 29]: V = 40, p = 0.03906 from both sides, the
  // shift is 0.46.
  const std::vector<double> before = {1.83, 0.50, 1.62, 2.48, 1.68, 1.88, 1.55, 3.06, 1.30};
  const std::vector<double> after = {0.878, 0.647, 0.598, 2.05, 1.06, 1.29, 1.06, 3.14, 1.29};
  std::vector<double> d;
  for (std::size_t i = 0; i < before.size(); ++i) d.push_back(before[i] - after[i]);
  const PairedDifference depression = signed_rank(d);
  EXPECT_TRUE(depression.exact);
  EXPECT_EQ(depression.v, 40.0);
  EXPECT_NEAR(depression.p, 0.0390625, 1e-9);
  EXPECT_NEAR(depression.shift.centre, 0.46, 1e-9);
  EXPECT_NEAR(depression.shift.low, 0.01, 1e-9);
  EXPECT_NEAR(depression.shift.high, 0.786, 1e-9);
  // Ties and a pair without a difference: ranks of 1, 1, 2, 3 are 1.5, 1.5, 3, 4; variance 7.5 - 6 / 48.
  const PairedDifference ties = signed_rank({0, 1, 1, 2, -3});
  EXPECT_FALSE(ties.exact);
  EXPECT_EQ(ties.n, 5U);
  EXPECT_EQ(ties.v, 6.0);
  EXPECT_NEAR(ties.p, std::erfc(0.5 / std::sqrt(2.0 * 7.375)), 1e-12);
  EXPECT_EQ(signed_rank({0, 0}).p, 1.0);
}

TEST(SignedRank, IsTheSameFromBothSidesAndOfAnyNumberOfPairs) {
  EXPECT_TRUE(rc::check([] {
    std::vector<double> d, means;
    for (const int n : *rc::gen::nonEmpty(rc::gen::container<std::vector<int>>(rc::gen::inRange(-30, 30))))
      d.push_back(n);
    std::vector<double> other;
    for (const double v : d) other.push_back(-v);
    for (std::size_t i = 0; i < d.size(); ++i) {
      for (std::size_t k = i; k < d.size(); ++k) means.push_back(0.5 * (d[i] + d[k]));
    }
    const PairedDifference a = signed_rank(d), b = signed_rank(other);
    RC_ASSERT(std::fabs(a.p - b.p) < 1e-9);
    RC_ASSERT(std::fabs(a.shift.low + b.shift.high) < 1e-9);
    RC_ASSERT(a.shift.low <= a.shift.centre && a.shift.centre <= a.shift.high);
    RC_ASSERT(std::fabs(a.shift.centre - median_and_quartiles(means).centre) < 1e-9);
    RC_ASSERT(a.a_larger == b.b_larger);
  }));
  std::vector<double> many;
  for (int i = 0; i < 20'000; ++i) many.push_back(i % 1000);
  const Summary s = shift_of_pairs(many);
  EXPECT_NEAR(s.centre, 499.5, 0.5);
  EXPECT_NEAR(s.high - s.low, 2 * 1.96 * 289 / std::sqrt(20'000.0), 1.0);
}

TEST(SignedRank, IsToldInWords) {
  EXPECT_EQ(in_words(signed_rank({4, 5, 6, 7, 8, -1}), "ideal", "slanted"),
            "no difference shows between ideal and slanted in 6 matched pairs, ideal - slanted is 5.5 (95 %: -1 to 8), "
            "ideal is larger in 5 and smaller in 1: Wilcoxon signed-rank V = 20, p = 0.062 (exact)");
}

TEST(Spearman, GivesWhatTablesGive) {
  // Ten students' IQ and hours of television: rho = -29 / 165, p = 0.627.
  const Correlation c =
      spearman({106, 100, 86, 101, 99, 103, 97, 113, 112, 110}, {7, 27, 2, 50, 28, 29, 20, 12, 6, 17});
  EXPECT_NEAR(c.rho, -29.0 / 165.0, 1e-12);
  EXPECT_NEAR(c.p, 0.627188, 1e-6);
  EXPECT_EQ(spearman({1, 2, 3, 4}, {10, 20, 30, 40}).rho, 1.0);
  EXPECT_THAT(in_words(spearman({1, 1, 1}, {1, 2, 3}), "x", "y"), HasSubstr("one of them is the same in all"));
}

TEST(Chart, ComparesRunsInPairs) {
  std::vector<Observation> all;
  for (const char* group : {"ideal", "slanted"}) {
    for (const char* x : {"1 m", "2 m"}) {
      for (int seed = 0; seed < 8; ++seed) {
        if (group[0] == 'i' && seed == 7) continue;  // failed: its pair does not count
        const double gain = group[0] == 'i' && x[0] == '2' ? seed + 1.0 : 0.0;
        all.push_back({"", group, x, 100.0 * seed + gain, 0, "seed " + std::to_string(seed)});
      }
    }
  }
  Chart chart;
  chart.x_name = "carry";
  chart.base = "slanted";
  const Selection selection{"items", "carry", "experiment", "", {}};
  ASSERT_TRUE(add_panels(chart, all, selection, "objects").ok());
  place_labels(chart);
  EXPECT_EQ(chart.x_label, "carry (m)");
  EXPECT_THAT(chart_table(chart),
              HasSubstr("items    -      ideal - slanted  2 m    7      4      2          6   1      7"));
  EXPECT_THAT(
      chart_differences(chart),
      testing::ElementsAre(
          "items, carry 1 m: no difference shows between ideal and slanted in 7 matched pairs, ideal - slanted is "
          "0 (95 %: 0 to 0), ideal is larger in 0 and smaller in 0: Wilcoxon signed-rank V = 0, p = 1, among 2 tests p "
          "= 1 (Holm)",
          HasSubstr("carry 2 m: ideal and slanted differ in 7 matched pairs, ideal - slanted is 4")));
  const std::string script = chart_script(chart, core::FigureFormat::Svg);
  EXPECT_THAT(script, HasSubstr("ideal − slanted"));
  EXPECT_THAT(script, HasSubstr("objects"));

  Chart wrong;
  wrong.base = "slnted";
  EXPECT_THAT(add_panels(wrong, all, selection).error().message, HasSubstr("Did you mean 'slanted'?"));
  for (Observation& o : all) o.pair += o.group;
  Chart none;
  none.base = "slanted";
  EXPECT_THAT(add_panels(none, all, selection).error().message, HasSubstr("no run of another group makes a pair"));
}

TEST(Chart, SetsEqualRunsOverAColumnSideBySide) {
  Chart chart;
  chart.show = Show::Runs;
  ASSERT_TRUE(add_panels(chart,
                         std::vector<Observation>{{"", "", "7 m", 5.0}, {"", "", "7 m", 5.0}, {"", "", "9 m", 6.0}},
                         {"items", "carry", "", "", {}})
                  .ok());
  place_labels(chart);
  EXPECT_THAT(chart_script(chart, core::FigureFormat::Svg), HasSubstr("$d0_0 << END\n-0.3 5\n0.0708"));
}

TEST(Chart, OrdersGroupsAndPanelsByTheirSize) {
  Chart chart;
  std::vector<Observation> all;
  for (const char* panel : {"10", "9"}) {  // as a table gives texts
    for (const char* group : {"10 cm/s", "5 cm/s"}) all.push_back({panel, group, "1", 1.0});
  }
  ASSERT_TRUE(add_panels(chart, all, {"items", "x", "velocity", "n", {}}).ok());
  place_labels(chart);
  EXPECT_EQ(chart.panels.at(0).title, "n = 9");
  EXPECT_EQ(chart.panels.at(0).groups.at(0).name, "5 cm/s");
  EXPECT_EQ(chart.groups.at(0), "5 cm/s");
}

TEST(Chart, DrawsEveryRunByItself) {
  Chart chart;
  chart.show = Show::Runs;
  chart.over_measure = true;
  chart.x_name = "x_m";
  add_panels(chart,
             std::vector<Way>{{"", "a", 1, {{0, 0}, {1, 2}}}, {"", "a", 2, {{0, 0}, {2, 5}}}, {"", "a", 3, {{3, 7}}}},
             {"y_m", "x_m", "treels", "", {}});
  place_labels(chart);
  const std::string script = chart_script(chart, core::FigureFormat::Svg);
  EXPECT_THAT(script, HasSubstr("$d0_0w << END\n0 0\n1 2\n\n0 0\n2 5\n\n3 7\n\nEND\n"));
  EXPECT_THAT(script, HasSubstr("$d0_0 << END\n1 2\n2 5\n3 7\nEND\n"));
  EXPECT_THAT(chart_differences(chart),
              testing::ElementsAre(HasSubstr("a: y_m and x_m in 3 runs rise together: Spearman rho = 1")));
  EXPECT_THAT(chart_table(chart), HasSubstr("y_m      -      a      -  3  5       3.5       6         2      7"));
}

/// R: p.adjust(c(0.01, 0.04, 0.03, 0.005), "holm").
TEST(Statistics, JudgesTestsThatAreReadTogether) {
  const std::vector<AmongTests> all = holm({0.01, 0.04, 0.03, 0.005});
  ASSERT_EQ(all.size(), 4U);
  const double wanted[] = {0.03, 0.06, 0.06, 0.02};
  for (std::size_t i = 0; i < 4; ++i) {
    EXPECT_NEAR(all[i].p, wanted[i], 1e-12) << i;
    EXPECT_EQ(all[i].count, 4U);
  }
  EXPECT_TRUE(holm({}).empty());
}

TEST(Chart, OrdersNumbersBySizeAndComparesGroupsAtEach) {
  Chart chart;
  chart.x_name = "carry";
  const Selection selection{"items", "carry", "experiment", "", {}};
  ASSERT_TRUE(add_panels(chart, observations(), selection).ok());
  place_labels(chart);
  EXPECT_TRUE(chart.numbers);
  EXPECT_EQ(chart.labels, (std::vector<std::string>{"1 m", "2 m", "10 m"}));
  EXPECT_EQ(chart.panels.at(0).groups.at(0).points.at(1).x, 2.0);
  const auto words = chart_differences(chart);
  ASSERT_EQ(words.size(), 3U);
  EXPECT_THAT(words[1],
              testing::StartsWith("items, carry 2 m: no difference shows between ideal (median 11.5, n = 4) and noise "
                                  "(median 1.5, n = 4)"));
  EXPECT_THAT(words[1], HasSubstr("p = 0.029 (exact)")) << "which would do, were it the only test of the chart";
  EXPECT_THAT(words[1], HasSubstr("among 3 tests p = 0.086 (Holm)"));
  EXPECT_THAT(chart_table(chart), HasSubstr("items    -      noise  10 m   4  1.5"));
  const std::string script = chart_script(chart, core::FigureFormat::Svg);
  EXPECT_THAT(script, HasSubstr("2 11.5 10.75 12.25\n"));
}

TEST(Chart, LetsNoTextOutOfItsQuotes) {
  Chart chart;
  chart.title = "x'\nsystem('touch owned')\n`touch owned`";
  chart.show = Show::Box;
  ASSERT_TRUE(add_panels(chart, std::vector<Observation>{{"", "it's", "`a`", 1.0}}, {"m'", "o", "b", "", {}}).ok());
  place_labels(chart);
  const std::string script = chart_script(chart, core::FigureFormat::Pdf);
  EXPECT_EQ(script.find('`'), std::string::npos);
  EXPECT_EQ(script.find("\nsystem"), std::string::npos);
}

}  // namespace
}  // namespace tandem::study
