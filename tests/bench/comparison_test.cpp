#include "bench/comparison.hpp"

#include <gtest/gtest.h>

#include "bench/spread.hpp"
#include "tests/bench/lines.hpp"

namespace tandem::bench {
namespace {

TEST(Comparison, DividesRunByRunAndShowsTheMedianOfTheRatios) {
  std::vector<ResultLine> lines;
  // The machine gets slower from run to run, so only runs of the same round can be compared.
  for (const auto& [one, two] : {std::pair{2.0, 1.0}, std::pair{6.0, 4.0}, std::pair{40.0, 10.0}}) {
    lines.push_back(line_of(1000, 0, one));
    lines.push_back(line_of(1000, 2, two));
    lines.push_back(on("dynamics2d", "A4", line_of(10, 0, one)));
  }
  lines.push_back(on("dynamics2d", "A4", line_of(10, 8, 1.0)));
  const auto rows = compare_threads(lines);
  ASSERT_EQ(rows.size(), 2U);
  EXPECT_EQ(rows[0].first, "kinematics2d, A1, N = 1000");
  EXPECT_EQ(rows[0].second, "P = 2: 2.00 times as fast as P = 0 (1.50 to 4.00, 3 pairs)");
  EXPECT_EQ(rows[1].first, "dynamics2d, A4, N = 10");
  EXPECT_EQ(rows[1].second, "P = 8: 2.00 times as fast as P = 0 (2.00 to 2.00, 1 pairs)");
}

TEST(Comparison, IsEmptyWhereNothingCanBeCompared) {
  EXPECT_TRUE(compare_threads({line_of(10, 0, 1.0), line_of(10, 0, 1.0), line_of(20, 2, 1.0)}).empty());
}

TEST(Spread, IsTheMedianWithTheSmallestAndTheLargest) {
  const Spread odd = spread_of({3.0, 1.0, 9.0});
  EXPECT_EQ(odd.median, 3.0);
  EXPECT_EQ(odd.smallest, 1.0);
  EXPECT_EQ(odd.largest, 9.0);
  EXPECT_EQ(spread_of({4.0, 1.0, 2.0, 100.0}).median, 3.0);
  EXPECT_EQ(spread_of({7.0}).median, 7.0);
}

}  // namespace
}  // namespace tandem::bench
