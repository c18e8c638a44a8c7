#include "bridges/emulation/delays.hpp"

#include <gtest/gtest.h>
#include <vector>

namespace tandem::bridges {
namespace {

TEST(DelayLine, GivesEachValueInItsTimeAndOnce) {
  DelayLine<int> line(0.03);
  EXPECT_FALSE(line.next_at());
  line.put(0, 1);
  line.put(10, 2);
  std::vector<std::pair<hal::TimeNs, int>> got;
  const auto note = [&got](hal::TimeNs at, int value) { got.emplace_back(at, value); };
  line.take(29'999'999, note);
  EXPECT_TRUE(got.empty());
  EXPECT_EQ(line.next_at(), 30'000'000);
  line.take(30'000'010, note);
  line.take(30'000'020, note);
  EXPECT_EQ(got, (std::vector<std::pair<hal::TimeNs, int>>{{30'000'000, 1}, {30'000'010, 2}}));
}

TEST(DelayLine, WithoutDelayIsNone) {
  DelayLine<int> line(0.0);
  line.put(5, 7);
  int got = 0;
  line.take(5, [&got](hal::TimeNs, int value) { got = value; });
  EXPECT_EQ(got, 7);
}

}  // namespace
}  // namespace tandem::bridges
