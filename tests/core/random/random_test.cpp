#include "core/random/random.hpp"

#include <cmath>
#include <gtest/gtest.h>

namespace tandem::core {
namespace {

TEST(Random, DependsOnEveryPartOfItsKey) {
  const auto base = draw(1, 2, Stream::Placement, 3, 4);
  EXPECT_EQ(draw(1, 2, Stream::Placement, 3, 4), base);
  EXPECT_NE(draw(2, 2, Stream::Placement, 3, 4), base);
  EXPECT_NE(draw(1, 3, Stream::Placement, 3, 4), base);
  EXPECT_NE(draw(1, 2, Stream::Orientation, 3, 4), base);
  EXPECT_NE(draw(1, 2, Stream::Placement, 4, 4), base);
  EXPECT_NE(draw(1, 2, Stream::Placement, 3, 5), base);
  EXPECT_NE(draw(1, 2, Stream::Placement, 3 + (std::int64_t{1} << 32), 4), base);
}

TEST(Random, UniformAndNormalHaveTheirMoments) {
  double mean = 0;
  double square = 0;
  double uniform = 0;
  constexpr int kDraws = 20000;
  for (int i = 0; i < kDraws; ++i) {
    const auto bits = draw(9, 0, Stream::WheelNoise, i);
    const auto normal = to_normal(bits[0], bits[1]);
    mean += normal[0];
    square += normal[0] * normal[0];
    const double u = to_unit(bits[2], bits[3]);
    ASSERT_TRUE(u >= 0.0 && u < 1.0);
    uniform += u;
  }
  EXPECT_NEAR(mean / kDraws, 0.0, 0.03);
  EXPECT_NEAR(square / kDraws, 1.0, 0.05);
  EXPECT_NEAR(uniform / kDraws, 0.5, 0.01);
  EXPECT_TRUE(std::isfinite(to_normal(0xFFFFFFFFU, 0)[0]));
}

}  // namespace
}  // namespace tandem::core
