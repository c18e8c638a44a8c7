#include <array>
#include <gtest/gtest.h>
#include <limits>

#include "hal/finite.hpp"
#include "hal/median.hpp"

namespace tandem::hal {
namespace {

constexpr double kInfinity = std::numeric_limits<double>::infinity(), kNan = std::numeric_limits<double>::quiet_NaN();

TEST(Finite, IsNeitherInfiniteNorNan) {
  EXPECT_TRUE(all_finite({}));
  EXPECT_TRUE(all_finite({0.0, -std::numeric_limits<double>::max(), std::numeric_limits<double>::denorm_min()}));
  for (const double odd : {kInfinity, -kInfinity, kNan}) {
    EXPECT_FALSE(all_finite({1.0, odd}));
    EXPECT_FALSE(all_finite(std::array<float, 3>{static_cast<float>(odd), 1.0F, 2.0F}));
    EXPECT_EQ(finite_or(odd, 3.0), 3.0);
  }
  EXPECT_EQ(finite_or(-2.0, 3.0), -2.0);
}

TEST(UpperMedian, HasAtMostHalfOfTheOthersOnEitherSide) {
  EXPECT_EQ(upper_median({}), 0.0);
  EXPECT_EQ(upper_median({4.0}), 4.0);
  EXPECT_EQ(upper_median({9.0, 1.0, 4.0}), 4.0);
  EXPECT_EQ(upper_median({9.0, 1.0}), 9.0) << "the upper of two";
  EXPECT_EQ(upper_median({5.0, 3.0, 8.0, 1.0}), 5.0);
}

}  // namespace
}  // namespace tandem::hal
