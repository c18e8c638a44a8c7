// Free motion against closed forms: falls, speeds, brakes, flights to a place, and arcs of wheels.
#include <algorithm>
#include <numbers>
#include <random>

#include "tests/core/physics/particle3d/bench.hpp"

namespace tandem::core {
namespace {

constexpr double kGravity_m_s2 = 9.81;
constexpr double kDrag_per_s = 0.4;

std::vector<Element::Attribute> airless() {
  return {attribute("drag", 0.0)};
}

// --- falling ---

TEST(Fall, FollowsTheClosedFormOfLinearDrag) {
  for (const double tick_s : {0.02, 0.1, 0.5}) {
    Bench bench(tick_s);
    const std::size_t row = bench.flyer(0, 0, 100);
    bench.drop(row);
    bench.motion(row).v_m_s = {1.5, -0.5, 2.0};
    const int ticks = static_cast<int>(std::lround(2.0 / tick_s));
    bench.steps(ticks);
    const double left = std::exp(-kDrag_per_s * 2.0);
    const double way = (1.0 - left) / kDrag_per_s;  // for each m/s at the start
    const double terminal = kGravity_m_s2 / kDrag_per_s;
    EXPECT_NEAR(bench.motion(row).v_m_s[2], 2.0 * left - terminal * (1.0 - left), 1e-11) << tick_s;
    EXPECT_NEAR(bench.motion(row).v_m_s[0], 1.5 * left, 1e-12) << tick_s;
    EXPECT_NEAR(bench.z(row), 100.0 + 2.0 * way - terminal * (2.0 - way), 1e-10) << tick_s;
    EXPECT_NEAR(bench.x(row), 1.5 * way, 1e-11) << tick_s;
    EXPECT_NEAR(bench.y(row), -0.5 * way, 1e-11) << tick_s;
  }
}

TEST(Fall, ComesToTheTerminalSpeed) {
  Bench bench;
  const std::size_t row = bench.flyer(0, 0, 5000);
  bench.drop(row);
  bench.steps(1000);
  EXPECT_NEAR(bench.motion(row).v_m_s[2], -kGravity_m_s2 / kDrag_per_s, 1e-9);
}

TEST(Fall, WithoutAirIsAParabola) {
  Bench bench(0.1, airless());
  const std::size_t row = bench.flyer(0, 0, 50);
  bench.drop(row);
  bench.motion(row).v_m_s = {1.0, 0.0, 3.0};
  bench.steps(20);
  EXPECT_NEAR(bench.z(row), 50.0 + 3.0 * 2.0 - 0.5 * kGravity_m_s2 * 4.0, 1e-10);
  EXPECT_NEAR(bench.x(row), 2.0, 1e-11);
  EXPECT_NEAR(bench.motion(row).v_m_s[2], 3.0 - 2.0 * kGravity_m_s2, 1e-11);
}

TEST(Fall, HasTheGravityThatTheFileGives) {
  Bench bench(0.1, {attribute("drag", 0.0), attribute("gravity", 1.62)});
  const std::size_t row = bench.flyer(0, 0, 50);
  bench.drop(row);
  bench.steps(10);
  EXPECT_NEAR(bench.z(row), 50.0 - 0.5 * 1.62, 1e-10);
}

TEST(Fall, EndsOnTheGroundAndLiesThere) {
  Bench bench;
  const std::size_t row = bench.flyer(0, 0, 2, 0.7);
  bench.drop(row);
  bench.motion(row).v_m_s = {2.0, 0.0, 0.0};
  for (int i = 0; i < 30; ++i) {
    bench.step();
    ASSERT_GE(bench.z(row), 0.0) << i;
  }
  EXPECT_EQ(bench.z(row), 0.0);
  EXPECT_EQ(bench.speed(row), 0.0);
  EXPECT_GT(bench.x(row), 1.0);  // it flew on while it fell, for 0.66 s
  EXPECT_LT(bench.x(row), 1.4);
  const std::vector<double> rest = bench.state();
  bench.steps(20);
  EXPECT_EQ(bench.state(), rest);
}

TEST(Fall, TakesOffFromWhereItLies) {
  Bench bench;
  const std::size_t row = bench.flyer(1, 2, 0);
  bench.drop(row);
  bench.steps(5);
  bench.fly_to(row, 1, 2, 1.5);
  bench.steps(50);
  EXPECT_NEAR(bench.z(row), 1.5, 1e-3);
}

// --- velocity ---

TEST(Velocity, IsReachedAtTheLimitOfAcceleration) {
  Bench bench(0.1, airless());
  const std::size_t row = bench.flyer(0, 0, 5);
  bench.fly(row, 1.2, 0.9, 0.0);  // 1.5 m/s
  for (int i = 1; i <= 10; ++i) {
    bench.step();
    const double speed = std::min(1.5, kFlyerAcceleration_m_s2 * 0.1 * i);
    ASSERT_NEAR(bench.speed(row), speed, 1e-12) << i;
    ASSERT_NEAR(bench.motion(row).v_m_s[1] * 1.2, bench.motion(row).v_m_s[0] * 0.9, 1e-12) << i;
  }
  // v^2 / (2 a) while it sped up, then at full speed.
  const double up_s = 1.5 / kFlyerAcceleration_m_s2;
  EXPECT_NEAR(std::hypot(bench.x(row), bench.y(row)), 0.5 * 1.5 * up_s + 1.5 * (1.0 - up_s), 1e-9);
  EXPECT_EQ(bench.z(row), 5.0);
}

TEST(Velocity, HoldsItsHeightAndPlaceWhileItHovers) {
  Bench bench;
  bench.flyer(1, -2, 3, 0.3);
  const std::vector<double> start = bench.state();
  bench.steps(100);
  EXPECT_EQ(bench.state(), start);
}

TEST(Velocity, StopsWithinTheClosedFormsWay) {
  for (const double drag : {0.0, 0.4}) {
    Bench bench(0.1, {attribute("drag", drag)});
    const std::size_t row = bench.flyer(0, 0, 5);
    bench.motion(row).v_m_s = {2.0, 0.0, 0.0};
    bench.fly(row, 0, 0, 0);
    bench.steps(20);
    EXPECT_EQ(bench.speed(row), 0.0) << drag;
    // dv/dt = -(a + k v) from v to 0; the last sub-step brakes less than it could, by at most a h^2 / 8.
    const double a = kFlyerAcceleration_m_s2;
    const double way = drag == 0.0 ? 4.0 / (2.0 * a) : 2.0 / drag - a / (drag * drag) * std::log1p(drag * 2.0 / a);
    EXPECT_NEAR(bench.x(row), way, a * 0.02 * 0.02 / 8.0 + 1e-9) << drag;
  }
}

TEST(Velocity, IsLimitedByDragWhereThatIsStronger) {
  Bench bench(0.1, {attribute("drag", 3.0)});  // 3 m/s^2 hold 1 m/s against it
  const std::size_t row = bench.flyer(0, 0, 5);
  bench.fly(row, 2, 0, 0);
  for (int i = 1; i <= 30; ++i) {
    bench.step();
    ASSERT_NEAR(bench.speed(row), 1.0 - std::exp(-0.3 * i), 1e-12) << i;
  }
}

TEST(Velocity, IsNeverMoreThanTheKindSays) {
  std::mt19937_64 random(5);
  std::uniform_real_distribution<double> any(-10.0, 10.0);
  for (const double drag : {0.0, 0.4, 5.0}) {
    Bench bench(0.1, {attribute("drag", drag)});
    for (int i = 0; i < 20; ++i) bench.flyer(2.0 * i - 19.0, 0, 100);
    for (int tick = 0; tick < 200; ++tick) {
      for (std::size_t row = 0; row < 20 && tick % 5 == 0; ++row) {
        if (random() % 2 == 0)
          bench.fly(row, any(random), any(random), any(random), any(random));
        else
          bench.fly_to(row, any(random), any(random), 100 + any(random), any(random));
      }
      bench.step();
      for (std::size_t row = 0; row < 20; ++row) ASSERT_LE(bench.speed(row), kFlyerSpeed_m_s * (1.0 + 1e-12)) << tick;
    }
  }
}

TEST(Velocity, ChangesNoFasterThanTheKindSays) {
  std::mt19937_64 random(6);
  std::uniform_real_distribution<double> any(-10.0, 10.0);
  Bench bench(0.1, airless());
  const std::size_t row = bench.flyer(0, 0, 100);
  for (int tick = 0; tick < 500; ++tick) {
    if (tick % 4 == 0)
      bench.fly(row, any(random), any(random), any(random));
    else if (tick % 4 == 2)
      bench.fly_to(row, any(random), any(random), 100 + any(random));
    const auto before = bench.motion(row).v_m_s;
    bench.step();
    const auto& v = bench.motion(row).v_m_s;
    ASSERT_LE(std::hypot(v[0] - before[0], v[1] - before[1], v[2] - before[2]),
              kFlyerAcceleration_m_s2 * 0.1 * (1.0 + 1e-12));
  }
}

TEST(Velocity, TurnsAtTheCommandedRateWithinItsLimit) {
  Bench bench;
  const std::size_t slow = bench.flyer(0, 0, 5, 3.0);
  const std::size_t fast = bench.flyer(5, 0, 5, 0.0);
  bench.fly(slow, 0, 0, 0, 0.5);
  bench.fly(fast, 0, 0, 0, -100.0);
  bench.steps(10);
  EXPECT_NEAR(bench.heading(slow), 3.5 - 2.0 * std::numbers::pi, 1e-12);
  EXPECT_NEAR(bench.heading(fast), -hal::eyebot::kind().flight()->max_turn_rad_s, 1e-12);
  EXPECT_NEAR(bench.motion(slow).w_rad_s[2], 0.5, 1e-15);
  const auto& q = bench.motion(slow).q_WB;
  EXPECT_NEAR(2.0 * std::atan2(q[3], q[0]), bench.heading(slow), 1e-12);
  EXPECT_NEAR(q[0] * q[0] + q[3] * q[3], 1.0, 1e-14);
}

// --- position ---

TEST(Position, IsReachedWithoutGoingPast) {
  for (const double tick_s : {0.01, 0.1, 0.5}) {
    for (const double way_m : {0.01, 0.3, 1.0, 12.0}) {
      Bench bench(tick_s);
      const std::size_t row = bench.flyer(-6, 1, 10);
      bench.fly_to(row, -6 + 0.6 * way_m, 1, 10 + 0.8 * way_m);
      double farthest_m = 0.0;
      const int ticks = static_cast<int>((way_m / kFlyerSpeed_m_s + 12.0) / tick_s);
      for (int i = 0; i < ticks; ++i) {
        bench.step();
        farthest_m = std::max(farthest_m, 0.6 * (bench.x(row) + 6) + 0.8 * (bench.z(row) - 10));
      }
      EXPECT_LE(farthest_m, way_m + 1e-9) << tick_s;
      EXPECT_NEAR(bench.x(row), -6 + 0.6 * way_m, 1e-3) << tick_s;
      EXPECT_NEAR(bench.z(row), 10 + 0.8 * way_m, 1e-3) << tick_s;
      EXPECT_NEAR(bench.speed(row), 0.0, 1e-3) << tick_s;
    }
  }
}

TEST(Position, IsReachedSoon) {
  Bench bench;
  const std::size_t row = bench.flyer(0, 0, 5);
  bench.fly_to(row, 10, 0, 5);
  // At full speed but for v / a to speed up, and a little longer to slow down: half of that each is lost.
  const double share = kFlyerSpeed_m_s / kFlyerAcceleration_m_s2;
  bench.steps(static_cast<int>((10.0 / kFlyerSpeed_m_s + 0.5 * share + 0.75 * share + 1.5) * 10.0));
  EXPECT_NEAR(bench.x(row), 10.0, 0.01);
}

TEST(Position, IsReachedFromAnySpeedWithinTheWayOfBraking) {
  for (int i = 0; i < 12; ++i) {
    const double angle = i * std::numbers::pi / 6.0;
    Bench bench;
    const std::size_t row = bench.flyer(0, 0, 5);
    bench.motion(row).v_m_s = {kFlyerSpeed_m_s * std::cos(angle), kFlyerSpeed_m_s * std::sin(angle), 0.0};
    bench.fly_to(row, 1.5, 0, 5);
    double farthest_m = 0.0;
    for (int tick = 0; tick < 150; ++tick) {
      bench.step();
      farthest_m = std::max(farthest_m, std::hypot(bench.x(row) - 1.5, bench.y(row)));
    }
    // The way of braking from full speed, besides the way that there is.
    const double brake_m = kFlyerSpeed_m_s * kFlyerSpeed_m_s / (2.0 * kFlyerAcceleration_m_s2);
    EXPECT_LT(farthest_m, 1.5 + brake_m) << angle;
    EXPECT_NEAR(bench.x(row), 1.5, 1e-3) << angle;
    EXPECT_NEAR(bench.y(row), 0.0, 1e-3) << angle;
    EXPECT_LT(bench.x(row) - 1.5, 1e-3);
  }
}

TEST(Position, TurnsTheShorterWayToItsHeading) {
  Bench bench;
  const std::size_t row = bench.flyer(0, 0, 5, 3.0);
  bench.fly_to(row, 0, 0, 5, -3.0);
  bench.step();
  EXPECT_NEAR(bench.heading(row), 3.0 + 0.1 * hal::eyebot::kind().flight()->max_turn_rad_s - 2.0 * std::numbers::pi,
              1e-12);
  bench.steps(5);
  EXPECT_NEAR(bench.heading(row), -3.0, 1e-12);
  bench.steps(20);
  EXPECT_NEAR(bench.heading(row), -3.0, 1e-12);
}

TEST(Position, OnTheGroundOrAboveTheCeilingIsAsNearAsCanBe) {
  Bench bench;
  bench.stores().max_z_m = 3.0;
  const std::size_t row = bench.flyer(0, 0, 1);
  bench.fly_to(row, 0, 0, -5);
  bench.steps(50);
  EXPECT_NEAR(bench.z(row), 0.0, 1e-6);
  EXPECT_NEAR(bench.speed(row), 0.0, 1e-6);
  bench.fly_to(row, 1, 0, 50);
  bench.steps(100);
  EXPECT_NEAR(bench.z(row), 3.0 - kFlyerHeight_m, 1e-6);
  EXPECT_NEAR(bench.x(row), 1.0, 0.02);
}

TEST(Position, StaysBetweenTheRegionsBottomAndTop) {
  Bench bench;
  Region& region = add_region(bench.space());
  region.bottom_m = 1.0;
  region.top_m = 4.0;
  const std::size_t row = bench.flyer(0, 0, 2);
  bench.drop(row);
  bench.steps(30);
  EXPECT_EQ(bench.z(row), 1.0);
  bench.fly(row, 0, 0, 2);
  bench.steps(60);
  EXPECT_EQ(bench.z(row), 4.0 - kFlyerHeight_m);
}

// --- wheels ---

TEST(Wheels, RollAlongExactArcs) {
  for (const double iterations : {1.0, 5.0, 17.0}) {
    for (const double tick_s : {0.01, 0.1, 0.3}) {
      Bench bench(tick_s, {attribute("iterations", iterations)});
      const double left = 0.05;
      const double right = 0.11;
      const std::size_t row = bench.roller(0.3, -0.4, 0.8, left, right);
      const int ticks = static_cast<int>(std::lround(9.0 / tick_s));
      bench.steps(ticks);
      const double turn = (right - left) / hal::epuck::kind().drive()->wheel_base_m * 9.0;
      const double radius = 0.5 * (left + right) / (right - left) * hal::epuck::kind().drive()->wheel_base_m;
      EXPECT_NEAR(bench.x(row), 0.3 + radius * (std::sin(0.8 + turn) - std::sin(0.8)), 1e-11) << tick_s;
      EXPECT_NEAR(bench.y(row), -0.4 - radius * (std::cos(0.8 + turn) - std::cos(0.8)), 1e-11) << tick_s;
      EXPECT_NEAR(std::remainder(bench.heading(row) - 0.8 - turn, 2.0 * std::numbers::pi), 0.0, 1e-11) << tick_s;
      EXPECT_NEAR(bench.stores().bodies.left_m[row], left * 9.0, 1e-12);
      EXPECT_NEAR(bench.stores().bodies.right_m[row], right * 9.0, 1e-12);
      EXPECT_EQ(bench.z(row), 0.0);
      EXPECT_NEAR(bench.motion(row).w_rad_s[2], (right - left) / hal::epuck::kind().drive()->wheel_base_m, 1e-12);
      EXPECT_NEAR(bench.speed(row), 0.08, 0.08 * 0.04);  // of the chord
    }
  }
}

TEST(Wheels, TurnOnTheSpot) {
  Bench bench;
  const std::size_t row = bench.roller(1, 1, 0, -0.1288, 0.1288);
  bench.steps(100);
  EXPECT_NEAR(bench.x(row), 1.0, 1e-12);
  EXPECT_NEAR(bench.y(row), 1.0, 1e-12);
  const double turn = 2 * 0.1288 / hal::epuck::kind().drive()->wheel_base_m * 10.0;
  EXPECT_NEAR(std::remainder(bench.heading(row) - turn, 2.0 * std::numbers::pi), 0.0, 1e-11);
}

TEST(Wheels, DriveOffABoxAndFallAndDriveOn) {
  Bench bench;
  bench.box(0, 0, 1, 1, 0, 0.3);
  const std::size_t row = bench.roller(0.3, 0, 0, 0.1, 0.1, 0.3);
  bench.steps(20);
  EXPECT_EQ(bench.z(row), 0.3);  // its rim still stands on the edge
  EXPECT_NEAR(bench.x(row), 0.5, 1e-9);
  bench.steps(3);
  EXPECT_EQ(bench.z(row), 0.3);
  bench.steps(7);
  EXPECT_EQ(bench.z(row), 0.0);
  const double landed_m = bench.x(row);
  EXPECT_GT(landed_m, 0.5 + kRollerRadius_m);
  bench.steps(10);
  EXPECT_NEAR(bench.x(row), landed_m + 0.1, 1e-9);
  EXPECT_EQ(bench.z(row), 0.0);
}

// --- what is wrong ---

TEST(Trouble, NamesTheBodyAndLeavesTheStoresAlone) {
  struct Case {
    const char* what;
    void (*spoil)(Bench&, std::size_t);
  };
  const Case cases[] = {
      {"has a position that is not a number", [](Bench& b, std::size_t r) { b.stores().bodies.y_m[r] = NAN; }},
      {"has a position that is not a number", [](Bench& b, std::size_t r) { b.motion(r).z_m = INFINITY; }},
      {"has a heading that is not a number", [](Bench& b, std::size_t r) { b.stores().bodies.cos_h[r] = NAN; }},
      {"has a speed that is not a number", [](Bench& b, std::size_t r) { b.motion(r).v_m_s[2] = NAN; }},
      {"is faster than 1000 m/s", [](Bench& b, std::size_t r) { b.motion(r).v_m_s[0] = 1e6; }},
      {"is commanded a flight that is not a number", [](Bench& b, std::size_t r) { b.flight(r).target[1] = NAN; }},
      {"is farther than 10000 km away", [](Bench& b, std::size_t r) { b.stores().bodies.x_m[r] = 1e9; }}};
  for (const Case& c : cases) {
    Bench bench;
    const std::size_t calm = bench.flyer(5, 0, 2);
    const std::size_t odd = bench.flyer(0, 0, 2);
    bench.fly(calm, 1, 0, 0);
    bench.fly(odd, 1, 0, 0);
    bench.steps(3);
    EXPECT_TRUE(bench.troubles().empty());
    c.spoil(bench, odd);
    const std::vector<double> before = bench.state();
    bench.step();
    const auto troubles = bench.troubles();
    ASSERT_EQ(troubles.size(), 1U) << c.what;
    EXPECT_EQ(troubles[0].body, BodyKey::robot(odd));
    EXPECT_EQ(troubles[0].what, c.what);
    const std::vector<double> after = bench.state();
    const std::size_t half = before.size() / 2;
    EXPECT_TRUE(std::equal(before.begin() + static_cast<std::ptrdiff_t>(half), before.end(),
                           after.begin() + static_cast<std::ptrdiff_t>(half),
                           [](double a, double b) { return a == b || (std::isnan(a) && std::isnan(b)); }))
        << c.what;
    EXPECT_NE(before[0], after[0]) << "the other flies on";
  }
}

TEST(Trouble, BadAttributesAreNamedWithTheirLine) {
  Element options;
  options.name = "particle3d";
  options.file = "file";
  options.line = 4;
  options.attributes = {{"gravity", "-9.81", 5}, {"drg", "1", 6}, {"id", "air", 4}};
  Element child;
  child.name = "spatial_hash";
  child.file = "file";
  child.line = 7;
  options.children.push_back(child);
  Problems problems;
  (void)particle3d_type().read(options, problems);
  std::string all;
  for (const Problem& p : problems) all += to_text(p) + "\n";
  EXPECT_EQ(problems.size(), 3U) << all;
  EXPECT_NE(all.find("file:5: error:"), std::string::npos) << all;
  EXPECT_NE(all.find("drag"), std::string::npos) << all;
  EXPECT_NE(all.find("file:7: error: <particle3d> cannot hold <spatial_hash>"), std::string::npos) << all;
}

}  // namespace
}  // namespace tandem::core
