// Two solvers side by side: bodies pass from one to the other, and meet across the border as they do without one.
#include <algorithm>
#include <numbers>

#include "tests/core/physics/particle3d/bench.hpp"

namespace tandem::core {
namespace {

void two_regions(Bench& bench) {
  add_region(bench.space(), {{-20, -20}, {0, -20}, {0, 20}, {-20, 20}});
  add_region(bench.space(), {{0, -20}, {20, -20}, {20, 20}, {0, 20}});
}

TEST(Border, LeavesNoTraceOnWhoCrossesIt) {
  Bench one;
  Bench two;
  two_regions(two);
  for (Bench* bench : {&one, &two}) {
    bench->fly(bench->flyer(-1.5, 0.3, 2), 1.1, 0.2, -0.1, 0.4);
    bench->fly_to(bench->flyer(1.0, 3, 2, 1.0), -2, 5, 1, -1.0);
    bench->drop(bench->flyer(-0.2, -3, 9));
    bench->motion(2).v_m_s = {1.0, 0, 0};
    bench->roller(-0.1, -1, 0.3, 0.1, 0.12);
  }
  for (int i = 0; i < 60; ++i) {
    one.step();
    two.step();
    ASSERT_EQ(one.state(), two.state()) << "tick " << i;
  }
  EXPECT_EQ(two.stores().bodies.region[0], 1);
  EXPECT_EQ(two.stores().bodies.region[1], 0);
  EXPECT_EQ(two.stores().bodies.region[2], 1);
}

TEST(Border, IsNoSeamForThoseThatMeetAtIt) {
  for (const bool fly : {true, false}) {
    Bench one;
    Bench two;
    two_regions(two);
    for (Bench* bench : {&one, &two}) {
      if (fly) {
        bench->fly(bench->flyer(-1, 0.01, 1), 1, 0, 0);
        bench->fly(bench->flyer(1, 0, 1), -1.2, 0, 0);
      } else {
        bench->roller(-0.3, 0.001, 0, 0.1, 0.1);
        bench->roller(0.3, 0, std::numbers::pi, 0.12, 0.12);
      }
    }
    double closest = 1e9;
    for (int i = 0; i < 80; ++i) {
      one.step();
      two.step();
      ASSERT_EQ(one.state(), two.state()) << "tick " << i << (fly ? ", flying" : ", rolling");
      closest = std::min(closest, std::hypot(two.x(0) - two.x(1), two.y(0) - two.y(1)));
    }
    const double radius_m = fly ? kFlyerRadius_m : kRollerRadius_m;
    EXPECT_NEAR(closest, 2.0 * radius_m, 1e-3);
  }
}

TEST(Border, KeepsMirroredBodiesAsTheyAre) {
  Bench bench;
  two_regions(bench);
  const std::size_t west = bench.flyer(-1, 0, 1);
  bench.fly(west, -1, 0, 0);
  bench.step();
  // Alone: what the neighbour makes of its double is thrown away, so one step is counted once.
  EXPECT_NEAR(bench.x(west), -1 - 0.5 * kFlyerAcceleration_m_s2 * 0.01, 0.001);
  EXPECT_EQ(bench.stores().regions[1].mirrored.size(), 1U);
}

TEST(Border, ReportsWhatIsWrongOnlyFromTheOwner) {
  Bench bench;
  two_regions(bench);
  const std::size_t west = bench.flyer(-0.5, 0, 1);
  bench.flyer(0.5, 0, 1);
  bench.step();
  bench.motion(west).v_m_s[0] = NAN;
  bench.step();
  const auto troubles = bench.troubles();
  ASSERT_EQ(troubles.size(), 1U);
  EXPECT_EQ(troubles[0].body, BodyKey::robot(west));
}

}  // namespace
}  // namespace tandem::core
