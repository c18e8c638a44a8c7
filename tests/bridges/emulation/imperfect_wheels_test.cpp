#include "bridges/emulation/imperfect_wheels.hpp"

#include <cmath>
#include <gtest/gtest.h>

namespace tandem::bridges {
namespace {

constexpr hal::TimeNs kMs = hal::kNsPerMs;

TEST(ImperfectWheels, RollTheirPartOfTheWayLate) {
  ImperfectWheels wheels({.left = 0.9, .right = 1.1, .delay_s = 0.05});
  wheels.tell(0, 0.1, 0.1);
  EXPECT_FALSE(wheels.still());
  auto ways = wheels.roll(0, 100 * kMs, 0, 0);
  EXPECT_NEAR(ways.left_m, 0.9 * 0.005, 1e-12);
  EXPECT_NEAR(ways.right_m, 1.1 * 0.005, 1e-12);
  wheels.tell(100 * kMs, 0, 0);
  ways = wheels.roll(100 * kMs, 300 * kMs, 0, 0);
  EXPECT_NEAR(ways.left_m, 0.9 * 0.005, 1e-12);
  wheels.roll(300 * kMs, 301 * kMs, 0, 0);
  EXPECT_TRUE(wheels.still());
}

TEST(ImperfectWheels, LoseTheirPlayWhenTheyTurnRound) {
  ImperfectWheels wheels({.backlash_m = 0.001});
  wheels.tell(0, 0.1, -0.1);
  auto ways = wheels.roll(0, 100 * kMs, 0, 0);
  EXPECT_NEAR(ways.left_m, 0.009, 1e-12);   // the play was at its back
  EXPECT_NEAR(ways.right_m, -0.01, 1e-12);  // and in front of this one
  wheels.tell(100 * kMs, -0.1, 0.1);
  ways = wheels.roll(100 * kMs, 200 * kMs, 0, 0);
  EXPECT_NEAR(ways.left_m, -0.009, 1e-12);
  EXPECT_NEAR(ways.right_m, 0.009, 1e-12);
}

TEST(ImperfectWheels, NoiseGrowsWithTheRootOfTheWay) {
  ImperfectWheels wheels({.noise_sqrt_m = 0.01});
  wheels.tell(0, 0.1, 0.1);
  double squares = 0.0;
  for (int i = 0; i < 4000; ++i) {
    const auto ways = wheels.roll(i * 100 * kMs, (i + 1) * 100 * kMs, 0, 0);
    squares += std::pow(ways.left_m - 0.01, 2.0);
  }
  EXPECT_NEAR(std::sqrt(squares / 4000.0), 0.001, 5e-5);
}

}  // namespace
}  // namespace tandem::bridges
