#include "mixed_reality/barrier/plane_program.hpp"

#include <cmath>
#include <gtest/gtest.h>
#include <limits>

#include "hal/random.hpp"

namespace tandem::mixed_reality {
namespace {

TEST(PlaneProgram, WhatIsAllowedIsLeftAsItIs) {
  PlaneProgram program;
  program.add(1.0, 0.0, 0.5);
  EXPECT_EQ(program.nearest(0.4, 3.0), (std::array<double, 2>{0.4, 3.0}));
}

TEST(PlaneProgram, LosesWhatLeadsThroughOneBoundAndBothAtACorner) {
  PlaneProgram program;
  program.add(1.0, 0.0, 0.5);
  EXPECT_EQ(program.nearest(2.0, 3.0), (std::array<double, 2>{0.5, 3.0}));
  program.add(0.0, 1.0, 0.25);
  EXPECT_EQ(program.nearest(2.0, 3.0), (std::array<double, 2>{0.5, 0.25}));
}

TEST(PlaneProgram, NoAllowedPointIsNearerThanItsOwn) {
  for (std::uint32_t trial = 0; trial < 300; ++trial) {
    hal::Random random(1, trial);
    PlaneProgram program;
    std::array<std::array<double, 3>, 6> bounds;
    for (auto& b : bounds) {
      const double angle = random.uniform(-3.15, 3.15);
      b = {std::cos(angle), std::sin(angle), random.uniform(0.0, 1.0)};
      program.add(b[0], b[1], b[2]);
    }
    const double x = random.uniform(-2.0, 2.0), y = random.uniform(-2.0, 2.0);
    const auto best = program.nearest(x, y);
    const auto allowed = [&](double px, double py, double slack) {
      for (const auto& b : bounds) {
        if (b[0] * px + b[1] * py > b[2] + slack) return false;
      }
      return true;
    };
    ASSERT_TRUE(allowed(best[0], best[1], 1e-8));
    const double off = std::hypot(best[0] - x, best[1] - y);
    for (int i = 0; i < 400; ++i) {
      const double px = random.uniform(-2.0, 2.0), py = random.uniform(-2.0, 2.0);
      ASSERT_TRUE(!allowed(px, py, 0.0) || std::hypot(px - x, py - y) >= off - 1e-8);
    }
  }
}

TEST(PlaneProgram, AnswersToStandWhereNumbersAreNoneOrBoundsTooMany) {
  PlaneProgram program;
  EXPECT_EQ(program.nearest(std::numeric_limits<double>::quiet_NaN(), 1.0), (std::array<double, 2>{}));
  for (std::size_t i = 0; i <= PlaneProgram::kMost; ++i) program.add(1.0, 0.0, 1.0);
  EXPECT_EQ(program.nearest(0.1, 0.1), (std::array<double, 2>{}));
}

}  // namespace
}  // namespace tandem::mixed_reality
