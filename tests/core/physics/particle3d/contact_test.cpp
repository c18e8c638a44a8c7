// What bodies run into: nothing solid is ever entered, and bodies part.
#include <algorithm>
#include <numbers>
#include <random>

#include "tests/core/physics/particle3d/bench.hpp"

namespace tandem::core {
namespace {

constexpr double kDeepest_m = 1e-6;

/// How deep an upright cylinder is in an object: the least way out. Closed forms that share nothing with the engine.
double depth_in(const Object& o, double x, double y, double z, double radius, double height) {
  const double up = o.z_high_m - z;
  const double down = z + height - o.z_low_m;
  double side = 0.0;
  if (o.kind == Object::Kind::Cylinder) {
    side = o.radius_m + radius - std::hypot(x - o.x_m, y - o.y_m);
  } else {
    const double dx = std::fabs(o.cos_h * (x - o.x_m) + o.sin_h * (y - o.y_m)) - o.half_x_m;
    const double dy = std::fabs(o.cos_h * (y - o.y_m) - o.sin_h * (x - o.x_m)) - o.half_y_m;
    side = dx > 0.0 && dy > 0.0 ? radius - std::hypot(dx, dy) : radius - std::max(dx, dy);
  }
  return std::min({up, down, side});
}

double depth_in_all(Bench& bench, std::size_t row) {
  const hal::RobotKind& kind = bench.stores().kind_of_row(row);
  double deepest = -1e9;
  for (const Object& o : bench.stores().objects) {
    deepest = std::max(deepest,
                       depth_in(o, bench.x(row), bench.y(row), bench.z(row), kind.body.radius_m, kind.body.height_m));
  }
  return deepest;
}

/// The least way apart of two robots; negative: the gap.
double overlap(Bench& bench, std::size_t a, std::size_t b) {
  const hal::RobotKind& sa = bench.stores().kind_of_row(a);
  const hal::RobotKind& sb = bench.stores().kind_of_row(b);
  return std::min({sa.body.radius_m + sb.body.radius_m - std::hypot(bench.x(a) - bench.x(b), bench.y(a) - bench.y(b)),
                   bench.z(a) + sa.body.height_m - bench.z(b), bench.z(b) + sb.body.height_m - bench.z(a)});
}

TEST(Solid, IsNeverEnteredWhateverIsCommanded) {
  for (const std::uint64_t seed : {1U, 2U, 3U, 4U, 5U, 6U}) {
    std::mt19937_64 random(seed);
    const auto between = [&random](double a, double b) { return std::uniform_real_distribution<double>(a, b)(random); };
    Bench bench(seed % 2 == 0 ? 0.1 : 0.25);
    bench.stores().max_z_m = 4.0;
    add_region(bench.space(), {{-6, -6}, {6, -6}, {6, 6}, {-6, 6}}, true);
    for (int i = 0; i < 25; ++i) {
      const double low = random() % 2 == 0 ? 0.0 : between(0.0, 3.0);
      const double high = low + between(0.005, 1.5);
      if (random() % 2 == 0)
        bench.cylinder(between(-6, 6), between(-6, 6), between(0.02, 0.8), low, high);
      else
        bench.box(between(-6, 6), between(-6, 6), between(0.005, 2), between(0.005, 2), low, high, between(-3, 3));
    }
    const auto place = [&](auto&& add) {
      for (;;) {
        const std::size_t row = add(between(-5.5, 5.5), between(-5.5, 5.5));
        if (depth_in_all(bench, row) < 0.0) return;
        bench.stores().bodies.flags[row] = 0;  // not there
      }
    };
    for (int i = 0; i < 15; ++i) {
      place([&](double x, double y) { return bench.flyer(x, y, between(0.0, 3.4)); });
      place([&](double x, double y) { return bench.roller(x, y, between(-3, 3), 0.1, 0.1); });
    }
    SpaceStores& s = bench.stores();
    int close = 0;
    for (int tick = 0; tick < 300; ++tick) {
      for (std::size_t row = 0; row < s.bodies.size(); ++row) {
        if (random() % 8 != 0) continue;
        if (!s.kind_of_row(row).flies()) {
          s.bodies.left_m_s[row] = between(-0.13, 0.13);
          s.bodies.right_m_s[row] = between(-0.13, 0.13);
        } else if (random() % 3 == 0) {
          bench.drop(row);
        } else if (random() % 2 == 0) {
          bench.fly(row, between(-2, 2), between(-2, 2), between(-2, 2), between(-2, 2));
        } else {
          bench.fly_to(row, between(-7, 7), between(-7, 7), between(-1, 5), between(-3, 3));
        }
      }
      bench.step();
      for (std::size_t row = 0; row < s.bodies.size(); ++row) {
        if ((s.bodies.flags[row] & kAlive) == 0) continue;
        const hal::RobotKind& kind = s.kind_of_row(row);
        const double depth = depth_in_all(bench, row);
        ASSERT_LE(depth, kDeepest_m) << "seed " << seed << " row " << row << " tick " << tick;
        if (depth > -1e-3) ++close;
        const double room = 6.0 - kind.body.radius_m;
        ASSERT_LE(std::max(std::fabs(bench.x(row)), std::fabs(bench.y(row))), room + kDeepest_m) << seed;
        ASSERT_GE(bench.z(row), 0.0);
        ASSERT_LE(bench.z(row), 4.0 - kind.body.height_m + kDeepest_m);
      }
    }
    EXPECT_TRUE(bench.troubles().empty());
    EXPECT_GT(close, 200) << "too few contacts to tell anything";
  }
}

TEST(Solid, ThinThingsAreNotJumpedOver) {
  Bench bench(0.5);
  bench.box(5, 0, 0.001, 8, 0, 5);   // a wall
  bench.box(-5, 0, 4, 4, 3, 3.001);  // a plate
  const std::size_t across = bench.flyer(0, 0, 1);
  const std::size_t down = bench.flyer(-5, 0, 300);
  const std::size_t up = bench.flyer(-5, 1, 0);
  bench.fly(across, kFlyerSpeed_m_s, 0, 0);
  bench.motion(across).v_m_s = {100, 0, 0};
  bench.drop(down);
  bench.motion(down).v_m_s = {0, 0, -200};
  bench.fly(up, 0, 0, kFlyerSpeed_m_s);
  bench.steps(40);
  EXPECT_NEAR(bench.x(across), 5 - 0.0005 - kFlyerRadius_m, kDeepest_m);
  EXPECT_NEAR(bench.z(down), 3.001, kDeepest_m);
  EXPECT_EQ(bench.speed(down), 0.0);
  EXPECT_NEAR(bench.z(up), 3.0 - kFlyerHeight_m, kDeepest_m);
}

TEST(Solid, BodiesSlideAlongWhatTheyMeet) {
  Bench bench(0.1, {attribute("drag", 0.0)});
  bench.box(2, 0, 0.2, 20, 0, 5);
  const std::size_t row = bench.flyer(0, -5, 1);
  bench.fly(row, 1, 1, 0);
  bench.steps(50);
  EXPECT_NEAR(bench.x(row), 1.9 - kFlyerRadius_m, kDeepest_m);
  const double before = bench.y(row);
  bench.steps(20);
  EXPECT_NEAR(bench.y(row) - before, 2.0, 0.02);
  EXPECT_NEAR(bench.motion(row).v_m_s[0], 0.0, 1e-9);
  EXPECT_NEAR(bench.motion(row).v_m_s[1], 1.0, 1e-9);
  EXPECT_EQ(bench.z(row), 1.0);
}

TEST(Solid, FlyersPassOverAndUnder) {
  Bench bench;
  bench.box(2, 0, 1, 1, 0, 0.5);
  bench.box(5, 0, 1, 1, 1.2, 2);
  const std::size_t row = bench.flyer(0, 0, 0.55);
  bench.fly(row, 1, 0, 0);
  bench.steps(90);
  EXPECT_GT(bench.x(row), 8.0);
  EXPECT_EQ(bench.z(row), 0.55);
}

TEST(Solid, WhoIsPutInsideSomethingComesOut) {
  Bench bench;
  bench.box(0, 0, 1, 1, 0, 2);
  const std::size_t row = bench.flyer(0.4, 0.1, 0.5);
  bench.steps(2);
  EXPECT_NEAR(bench.x(row), 0.5 + kFlyerRadius_m, kDeepest_m);
  EXPECT_NEAR(bench.y(row), 0.1, kDeepest_m);
}

TEST(Solid, AFallenRobotLiesOnWhatIsBeneathIt) {
  Bench bench;
  bench.cylinder(0, 0, 0.5, 0, 1.2);
  const std::size_t flyer = bench.flyer(0.6, 0, 3);  // its rim is above the cylinder
  bench.drop(flyer);
  const std::size_t roller = bench.roller(-0.2, 0, 0, 0, 0, 2.0);
  bench.steps(40);
  EXPECT_NEAR(bench.z(flyer), 1.2, kDeepest_m);
  EXPECT_NEAR(bench.z(roller), 1.2, kDeepest_m);
  EXPECT_EQ(bench.speed(flyer), 0.0);
  EXPECT_EQ(bench.speed(roller), 0.0);
}

TEST(Bodies, ThatMeetHeadOnStopInTheMiddle) {
  for (const bool fly : {true, false}) {
    Bench bench;
    const std::size_t a = fly ? bench.flyer(-2, 0, 1) : bench.roller(-0.5, 0, 0, 0.1, 0.1);
    const std::size_t b = fly ? bench.flyer(2, 0, 1) : bench.roller(0.5, 0, std::numbers::pi, 0.1, 0.1);
    if (fly) {
      bench.fly(a, 1, 0, 0);
      bench.fly(b, -1, 0, 0);
    }
    double deepest = -1.0;
    for (int i = 0; i < 100; ++i) {
      bench.step();
      ASSERT_NEAR(bench.x(a), -bench.x(b), 1e-12) << i;
      deepest = std::max(deepest, overlap(bench, a, b));
    }
    EXPECT_LE(deepest, 1e-9) << fly;
    EXPECT_GT(deepest, -1e-2) << fly;
    EXPECT_NEAR(bench.y(a), 0.0, 1e-9);
  }
}

TEST(Bodies, StandOnOneAnotherWhereThatIsTheShorterWay) {
  Bench bench;
  const std::size_t low = bench.flyer(0, 0, 1);
  const std::size_t high = bench.flyer(0.1, 0, 2.5);
  bench.fly_to(low, 0, 0, 1);
  bench.fly(high, 0, 0, -0.5);
  double deepest = -1.0;
  for (int i = 0; i < 100; ++i) {
    bench.step();
    deepest = std::max(deepest, overlap(bench, low, high));
  }
  EXPECT_LE(deepest, 1e-9);
  EXPECT_NEAR(bench.x(high), 0.1, 1e-9);
  EXPECT_NEAR(bench.x(low), 0.0, 1e-9);
  EXPECT_NEAR(bench.z(high) - bench.z(low), kFlyerHeight_m, 0.02);
}

TEST(Bodies, OnTheGroundDoNotFeelThoseAbove) {
  Bench bench;
  const std::size_t roller = bench.roller(0, 0, 0, 0.1, 0.1);
  const std::size_t flyer = bench.flyer(0.2, 0, kRollerHeight_m + 0.01);
  bench.steps(30);
  EXPECT_NEAR(bench.x(roller), 0.3, 1e-12);
  EXPECT_EQ(bench.x(flyer), 0.2);
  EXPECT_EQ(bench.z(flyer), kRollerHeight_m + 0.01);
}

TEST(Bodies, ThatLandOnWheeledOnesStandOnThem) {
  Bench bench;
  const std::size_t roller = bench.roller(0, 0, 0, 0, 0);
  const std::size_t flyer = bench.flyer(0.05, 0, 1);
  bench.fly(flyer, 0, 0, -0.3);
  bench.steps(60);
  EXPECT_EQ(bench.z(roller), 0.0);
  EXPECT_EQ(bench.x(roller), 0.0);
  EXPECT_NEAR(bench.z(flyer), kRollerHeight_m, 1e-3);
}

TEST(Bodies, MovedFromOutsidePushAndAreNotPushed) {
  Bench bench;
  const std::size_t real = bench.flyer(0, 0, 1, 0.4);
  const std::size_t hovers = bench.flyer(0.7, 0, 1);
  bench.fly(real, 1, 1, 1, 1);
  bench.stores().bodies.flags[real] |= kExternal;
  bench.motion(real).v_m_s = {0.5, 0, 0};
  for (int i = 0; i < 40; ++i) {
    const double x_m = 0.05 * (i + 1);
    bench.stores().bodies.x_m[real] = x_m;
    const auto q = bench.motion(real).q_WB;
    bench.step();
    ASSERT_EQ(bench.x(real), x_m);
    ASSERT_EQ(bench.z(real), 1.0);
    ASSERT_EQ(bench.stores().bodies.cos_h[real], std::cos(0.4));
    ASSERT_EQ(bench.motion(real).q_WB, q);
    ASSERT_EQ(bench.motion(real).v_m_s[0], 0.5);
    ASSERT_LE(overlap(bench, real, hovers), 1e-9) << i;
  }
  EXPECT_NEAR(bench.x(hovers), 2.0 + 2 * kFlyerRadius_m, 1e-6);
}

TEST(Bodies, GainNoEnergyFromMeeting) {
  std::mt19937_64 random(9);
  std::uniform_real_distribution<double> any(-1.0, 1.0);
  Bench bench(0.1, {attribute("drag", 0.0), attribute("gravity", 0.0)});
  constexpr std::size_t kBodies = 30;
  for (std::size_t i = 0; i < kBodies; ++i) {
    const std::size_t row = bench.flyer(0.6 * static_cast<double>(i % 6), 0.6 * static_cast<double>(i / 6), 5);
    bench.drop(row);
    bench.motion(row).v_m_s = {any(random), any(random), 0.2 * any(random)};
  }
  const auto energy = [&] {
    double sum = 0.0;
    for (std::size_t i = 0; i < kBodies; ++i) sum += bench.speed(i) * bench.speed(i);
    return sum;
  };
  double last = energy();
  const double first = last;
  for (int i = 0; i < 50; ++i) {
    bench.step();
    ASSERT_LE(energy(), last * (1.0 + 1e-12)) << i;
    last = energy();
  }
  EXPECT_LT(last, 0.95 * first);  // some met
}

TEST(Run, IsTheSameToTheBitTwice) {
  const auto run = [] {
    std::mt19937_64 random(3);
    std::uniform_real_distribution<double> any(-1.0, 1.0);
    Bench bench;
    bench.box(0, 0, 1, 1, 0, 1, 0.3);
    for (int i = 0; i < 40; ++i) {
      bench.roller(3 * any(random), 3 * any(random), 3 * any(random), 0.1, 0.12);
      bench.fly(bench.flyer(3 * any(random), 3 * any(random), 1 + any(random)), any(random), any(random), any(random));
    }
    bench.steps(60);
    return bench.state();
  };
  const std::vector<double> once = run();
  EXPECT_EQ(run(), once);
}

}  // namespace
}  // namespace tandem::core
