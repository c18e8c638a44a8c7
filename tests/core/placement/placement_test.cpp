#include "core/placement/placement.hpp"

#include <cmath>
#include <gmock/gmock.h>
#include <numbers>
#include <set>

namespace tandem::core {
namespace {

using testing::ElementsAre;
using testing::HasSubstr;

constexpr double kRadius_m = 0.035;
constexpr double kPi = std::numbers::pi;

BodySize size_of(const std::string& kind) {
  return {kind == "e-puck" ? kRadius_m : kind == "big" ? 0.5 : kind == "flyer" ? 0.2 : -1.0, 0.1, kind == "flyer"};
}

Scenario arena(double size_m) {
  Scenario s;
  s.file = "file.xml";
  s.arena_size = {size_m, size_m, 1.0};
  return s;
}

Distribute uniform(std::int64_t quantity, double half_m, std::int64_t max_trials = 1000) {
  Distribute d;
  d.quantity = quantity;
  d.max_trials = max_trials;
  d.position.method = Distribution::Method::Uniform;
  d.position.min = {-half_m, -half_m, 0.0};
  d.position.max = {half_m, half_m, 0.0};
  d.orientation.method = Distribution::Method::Uniform;
  d.orientation.min = {0.0, 0.0, 0.0};
  d.orientation.max = {2.0 * kPi, 0.0, 0.0};
  d.line = 50;
  return d;
}

RobotItem robot(const std::string& id, double x_m, double y_m, double yaw_rad = 0.0) {
  RobotItem r;
  r.kind = "e-puck";
  r.id = id;
  r.placement = {{x_m, y_m, 0.0}, yaw_rad, 0.0, 0.0};
  r.line = 10;
  return r;
}

RobotItem robots(const std::string& id, const Distribute& d) {
  RobotItem r = robot(id, 0, 0);
  r.distribute = d;
  return r;
}

ObjectItem box(double x_m, double y_m, double size_x_m, double size_y_m, double yaw_rad = 0.0) {
  ObjectItem o;
  o.id = "crate";
  o.size = {size_x_m, size_y_m, 0.5};
  o.placement = {{x_m, y_m, 0.0}, yaw_rad, 0.0, 0.0};
  o.line = 20;
  return o;
}

ObjectItem cylinder(double x_m, double y_m, double radius_m) {
  ObjectItem o;
  o.shape = ShapeKind::Cylinder;
  o.id = "post";
  o.size = {radius_m, radius_m, 0.5};
  o.placement.p_W = {x_m, y_m, 0.0};
  o.line = 30;
  return o;
}

std::string texts(const Problems& problems) {
  std::string all;
  for (const Problem& p : problems) all += to_text(p) + "\n";
  return all;
}

Placements placed(const Scenario& s, std::uint64_t seed = 1) {
  Problems problems;
  Placements out = place(s, seed, &size_of, problems);
  EXPECT_TRUE(problems.empty()) << texts(problems);
  return out;
}

std::string problem_of(const Scenario& s) {
  Problems problems;
  (void)place(s, 1, &size_of, problems);
  EXPECT_EQ(problems.size(), 1U) << texts(problems);
  return problems.empty() ? "" : to_text(problems.front());
}

/// Distance of a point from a rectangle, by its corners' frame: 0 inside.
double distance_to_box(double x, double y, const Vec3& p, const Vec3& size, double yaw) {
  const double rx = std::cos(yaw) * (x - p[0]) + std::sin(yaw) * (y - p[1]);
  const double ry = -std::sin(yaw) * (x - p[0]) + std::cos(yaw) * (y - p[1]);
  return std::hypot(std::max(std::fabs(rx) - size[0] / 2, 0.0), std::max(std::fabs(ry) - size[1] / 2, 0.0));
}

void expect_no_overlap(const Scenario& s, const Placements& p) {
  int overlaps = 0;
  for (std::size_t i = 0; i < p.robots.size(); ++i) {
    const PlacedRobot& a = p.robots[i];
    for (std::size_t k = 0; k < i; ++k) {
      const PlacedRobot& b = p.robots[k];
      if (std::hypot(a.x_m - b.x_m, a.y_m - b.y_m) < 2.0 * kRadius_m) ++overlaps;
    }
    for (const PlacedObject& o : p.objects) {
      const ObjectItem& item = s.objects[o.item];
      const double gap = item.shape == ShapeKind::Box ? distance_to_box(a.x_m, a.y_m, o.p_W, item.size, o.yaw_rad)
                                                      : std::hypot(a.x_m - o.p_W[0], a.y_m - o.p_W[1]) - item.size[0];
      if (gap < kRadius_m - 1e-12) ++overlaps;
    }
  }
  EXPECT_EQ(overlaps, 0);
}

TEST(Placement, KeepsWhatTheFileSays) {
  Scenario s = arena(4);
  s.robots = {robot("a", 1, -1, 0.5), robot("b", -1, 1, 1.5 * kPi)};
  s.robots[0].placement.p_W[2] = 0.25;
  s.objects = {box(0, 0, 0.2, 0.4, 0.3)};
  LightItem lamp;
  lamp.p_W = {1, 2, 3};
  s.lights = {lamp};
  const Placements p = placed(s);
  ASSERT_EQ(p.robots.size(), 2U);
  EXPECT_EQ(p.robots[0].x_m, 1.0);
  EXPECT_EQ(p.robots[0].y_m, -1.0);
  EXPECT_EQ(p.robots[0].z_m, 0.25);
  EXPECT_EQ(p.robots[0].yaw_rad, 0.5);
  EXPECT_EQ(p.robots[0].number, -1);
  EXPECT_DOUBLE_EQ(p.robots[1].yaw_rad, -0.5 * kPi) << "yaws are in (-pi, pi]";
  EXPECT_EQ(p.robots[1].item, 1U);
  ASSERT_EQ(p.objects.size(), 1U);
  EXPECT_EQ(p.objects[0].yaw_rad, 0.3);
  ASSERT_EQ(p.lights.size(), 1U);
  EXPECT_EQ(p.lights[0].p_W, (Vec3{1, 2, 3}));
}

TEST(Placement, NeverOverlapsInACrowd) {
  Scenario s = arena(3);
  s.objects = {box(0.5, 0.5, 0.8, 0.3, 0.6), box(-0.8, 0, 0.1, 2.0), cylinder(0.3, -0.8, 0.4), box(0, 1.45, 3, 0.1)};
  s.robots = {robot("first", -0.2, -0.2), robots("ep", uniform(700, 1.45, 10000))};
  const Placements p = placed(s);
  EXPECT_EQ(p.robots.size(), 701U);
  expect_no_overlap(s, p);
}

TEST(Placement, NeverOverlapsDistributedThings) {
  Scenario s = arena(4);
  ObjectItem crates = box(0, 0, 0.5, 0.2);
  crates.distribute = uniform(12, 1.8);
  ObjectItem posts = cylinder(0, 0, 0.1);
  posts.distribute = uniform(12, 1.8);
  s.objects = {crates, posts};
  s.robots = {robots("ep", uniform(300, 1.9))};
  const Placements p = placed(s);
  ASSERT_EQ(p.objects.size(), 24U);
  expect_no_overlap(s, p);
  // Boxes among themselves: no corner and no point of an edge of one lies in another.
  int inside = 0;
  for (const PlacedObject& a : p.objects) {
    if (a.item != 0) continue;
    for (const PlacedObject& b : p.objects) {
      if (&a == &b) continue;
      for (int i = 0; i <= 40; ++i) {
        for (const double side : {-0.5, 0.5}) {
          const double u = (i / 40.0 - 0.5) * 0.5;
          const double v = side * 0.2;
          const double x = a.p_W[0] + std::cos(a.yaw_rad) * u - std::sin(a.yaw_rad) * v;
          const double y = a.p_W[1] + std::sin(a.yaw_rad) * u + std::cos(a.yaw_rad) * v;
          const bool hit = b.item == 0 ? distance_to_box(x, y, b.p_W, s.objects[0].size, b.yaw_rad) == 0.0
                                       : std::hypot(x - b.p_W[0], y - b.p_W[1]) < 0.1 - 1e-12;
          inside += hit ? 1 : 0;
        }
      }
    }
  }
  EXPECT_EQ(inside, 0);
}

TEST(Placement, IsAFunctionOfTheSeed) {
  Scenario s = arena(4);
  s.robots = {robots("ep", uniform(100, 1.9))};
  const auto first = placed(s, 1).robots;
  const auto again = placed(s, 1).robots;
  const auto other = placed(s, 2).robots;
  int same = 0;
  for (std::size_t i = 0; i < first.size(); ++i) {
    EXPECT_EQ(first[i].x_m, again[i].x_m);
    EXPECT_EQ(first[i].yaw_rad, again[i].yaw_rad);
    same += first[i].x_m == other[i].x_m ? 1 : 0;
  }
  EXPECT_LT(same, 3);
}

TEST(Placement, OfTheFirstDoesNotDependOnHowManyFollow) {
  Scenario few = arena(4);
  few.robots = {robots("ep", uniform(10, 1.9))};
  Scenario many = arena(4);
  many.robots = {robots("ep", uniform(500, 1.9)), robots("more", uniform(5, 1.9))};
  const auto a = placed(few).robots;
  const auto b = placed(many).robots;
  for (std::size_t i = 0; i < a.size(); ++i) EXPECT_EQ(a[i].x_m, b[i].x_m);
}

TEST(Placement, NumbersFromBaseNumInOrder) {
  Scenario s = arena(4);
  Distribute d = uniform(3, 1.9);
  d.base_num = 7;
  s.robots = {robots("ep", d), robot("single", 0, 0)};
  std::vector<std::int64_t> numbers;
  std::vector<std::uint32_t> items;
  for (const PlacedRobot& r : placed(s).robots) {
    numbers.push_back(r.number);
    items.push_back(r.item);
  }
  EXPECT_THAT(numbers, ElementsAre(7, 8, 9, -1));
  EXPECT_THAT(items, ElementsAre(0, 0, 0, 1));
}

TEST(Placement, UniformFillsItsBoxEvenly) {
  Scenario s = arena(40);
  Distribute d = uniform(4000, 0);
  d.position.min = {-10, 5, -1};
  d.position.max = {10, 15, 3};
  s.robots = {robots("ep", d)};
  double x = 0, y = 0, z = 0, xx = 0, c = 0, n = 0;
  for (const PlacedRobot& r : placed(s).robots) {
    EXPECT_GE(r.x_m, -10);
    EXPECT_LT(r.x_m, 10);
    EXPECT_GE(r.y_m, 5);
    EXPECT_LT(r.y_m, 15);
    EXPECT_GT(r.yaw_rad, -kPi);
    EXPECT_LE(r.yaw_rad, kPi);
    x += r.x_m;
    y += r.y_m;
    z += r.z_m;
    xx += r.x_m * r.x_m;
    c += std::cos(r.yaw_rad);
    n += 1;
  }
  // Five standard errors.
  EXPECT_NEAR(x / n, 0.0, 5 * 20 / std::sqrt(12 * n));
  EXPECT_NEAR(y / n, 10.0, 5 * 10 / std::sqrt(12 * n));
  EXPECT_NEAR(z / n, 1.0, 5 * 4 / std::sqrt(12 * n));
  EXPECT_NEAR(xx / n, 400.0 / 12.0, 5 * std::sqrt(400.0 * 400.0 / 180.0 / n));
  EXPECT_NEAR(c / n, 0.0, 5 * std::sqrt(0.5 / n));
}

// Far apart, so that the ban on overlaps does not spread them.
TEST(Placement, GaussianHasItsMeanAndDeviation) {
  Scenario s = arena(2000);
  Distribute d = uniform(4000, 0);
  d.position.method = Distribution::Method::Gaussian;
  d.position.mean = {3, -4, 0};
  d.position.std_dev = {50, 20, 0};
  s.robots = {robots("ep", d)};
  double x = 0, y = 0, xx = 0, yy = 0, xy = 0, n = 0;
  for (const PlacedRobot& r : placed(s).robots) {
    x += r.x_m - 3;
    y += r.y_m + 4;
    xx += (r.x_m - 3) * (r.x_m - 3);
    yy += (r.y_m + 4) * (r.y_m + 4);
    xy += (r.x_m - 3) * (r.y_m + 4);
    n += 1;
    EXPECT_EQ(r.z_m, 0.0);
  }
  EXPECT_NEAR(x / n, 0.0, 5 * 50 / std::sqrt(n));
  EXPECT_NEAR(y / n, 0.0, 5 * 20 / std::sqrt(n));
  EXPECT_NEAR(xx / n, 2500.0, 5 * 2500 * std::sqrt(2 / n));
  EXPECT_NEAR(yy / n, 400.0, 5 * 400 * std::sqrt(2 / n));
  EXPECT_NEAR(xy / n, 0.0, 5 * 1000 / std::sqrt(n));
}

TEST(Placement, GridIsCentredAndFilledFromTheSouthWest) {
  Scenario s = arena(4);
  Distribute d = uniform(5, 0);
  d.position = {};
  d.position.method = Distribution::Method::Grid;
  d.position.center = {1, 0, 0};
  d.position.distances = {0.5, 0.4, 1};
  d.position.layout = {3, 2, 1};
  d.orientation = {};
  d.orientation.values = {0.25, 0, 0};
  s.robots = {robots("ep", d)};
  const auto r = placed(s).robots;
  ASSERT_EQ(r.size(), 5U);
  EXPECT_DOUBLE_EQ(r[0].x_m, 0.5);
  EXPECT_DOUBLE_EQ(r[0].y_m, -0.2);
  EXPECT_DOUBLE_EQ(r[2].x_m, 1.5);
  EXPECT_DOUBLE_EQ(r[2].y_m, -0.2);
  EXPECT_DOUBLE_EQ(r[3].x_m, 0.5);
  EXPECT_DOUBLE_EQ(r[3].y_m, 0.2);
  EXPECT_EQ(r[4].yaw_rad, 0.25);
}

TEST(Placement, WhatHasAPlaceGoesFirstThenDistributesInTheOrderOfTheFile) {
  // The robots are distributed before the boxes that fill the arena: they find room, the boxes do not.
  Scenario s = arena(2);
  ObjectItem crates = box(0, 0, 1.2, 1.2);
  crates.distribute = uniform(1, 0.4, 50);
  crates.distribute->order = 1;
  s.objects = {crates};
  s.robots = {robots("ep", uniform(60, 0.9))};
  EXPECT_THAT(problem_of(s), HasSubstr("placed 0 of 1 of box 'crate'"));
  s.objects[0].distribute->order = 0;
  s.robots[0].distribute->order = 1;
  EXPECT_EQ(placed(s).robots.size(), 60U);
  // One with a place of its own is never in the way of nobody: it stands where the file says, whatever the order.
  s.robots.push_back(robot("fixed", 0.95, 0.95));
  const auto all = placed(s).robots;
  EXPECT_EQ(all.back().x_m, 0.95);
}

TEST(Placement, SaysHowManyWerePlacedWhenThereIsNoRoom) {
  Scenario s = arena(0.5);
  s.robots = {robots("ep", uniform(1000, 0.25, 20))};
  const std::string text = problem_of(s);
  EXPECT_THAT(text, testing::StartsWith("file.xml:50: error: placed "));
  EXPECT_THAT(text, HasSubstr(" of 1000 of robot 'ep': no free place in 20 trials"));
  EXPECT_THAT(text, HasSubstr("more room, fewer of them, or more max_trials"));
}

TEST(Placement, SaysWhatIsInTheWayOfAConstantPlace) {
  Scenario s = arena(2);
  Distribute d = uniform(1, 0);
  d.position = {};
  d.position.values = {0.1, 0, 0};
  s.robots = {robots("ep", d)};
  s.objects = {box(0, 0, 1, 1)};
  EXPECT_EQ(problem_of(s),
            "file.xml:50: error: placed 0 of 1 of robot 'ep': (0.1, 0) is taken by box 'crate' of line 20");
  s.robots[0].distribute->position.values = {1.5, 0, 0};
  EXPECT_EQ(problem_of(s), "file.xml:50: error: placed 0 of 1 of robot 'ep': (1.5, 0) is outside the arena");
}

TEST(Placement, NamesBothOfTwoThatOverlap) {
  Scenario s = arena(4);
  s.robots = {robot("a", 0, 0), robot("b", 0.06, 0)};
  EXPECT_EQ(problem_of(s), "file.xml:10: error: robot 'b' overlaps robot 'a' of line 10; move one of them");
  s.robots = {robot("a", 0, 0)};
  s.objects = {cylinder(0.1, 0, 0.08)};
  EXPECT_EQ(problem_of(s), "file.xml:10: error: robot 'a' overlaps cylinder 'post' of line 30; move one of them");
}

TEST(Placement, LetsThingsTouch) {
  Scenario s = arena(4);
  s.robots = {robot("a", 0, 0), robot("b", 2.0 * kRadius_m, 0)};
  s.objects = {box(-0.5 - kRadius_m, 0, 1, 1)};
  EXPECT_EQ(placed(s).robots.size(), 2U);
}

TEST(Placement, LetsWallsMeetButNotThingsThatMove) {
  Scenario s = arena(4);
  s.objects = {box(0, 1, 4, 0.1), box(1, 0, 0.1, 4)};
  EXPECT_EQ(placed(s).objects.size(), 2U);
  s.objects[1].movable = true;
  EXPECT_THAT(problem_of(s), HasSubstr("box 'crate' of line 20 overlaps box 'crate' of line 20"));
}

TEST(Placement, RefusesARobotOutsideTheArena) {
  Scenario s = arena(4);
  s.arena_center = {10, 0, 0};
  s.robots = {robot("a", 10, 0), robot("b", 0, 0)};
  EXPECT_EQ(problem_of(s), "file.xml:10: error: robot 'b' is at (0, 0), outside the arena");
}

TEST(Placement, RefusesAMovableObjectOutsideTheArena) {
  Scenario s = arena(4);
  s.objects = {box(9, 0, 0.2, 0.2)};
  EXPECT_EQ(placed(s).objects.size(), 1U) << "a wall may stand anywhere";
  s.objects[0].movable = true;
  EXPECT_THAT(problem_of(s), HasSubstr("box 'crate' of line 20 is at (9, 0), outside the arena"));
}

TEST(Placement, RefusesARobotBelowTheGround) {
  Scenario s = arena(4);
  s.robots = {robot("a", 0, 0)};
  s.robots[0].placement.p_W[2] = -0.2;
  EXPECT_THAT(problem_of(s), HasSubstr("robot 'a' is at a height of -0.2 m, below the ground"));
}

TEST(Placement, LeavesOutRobotsOfUnknownKinds) {
  Scenario s = arena(4);
  s.robots = {robot("a", 0, 0), robots("b", uniform(5, 1))};
  for (RobotItem& r : s.robots) r.kind = "mystery";
  EXPECT_TRUE(placed(s).robots.empty());
}

TEST(Placement, RobotsThatFlyPassOverWhatIsLow) {
  Scenario s = arena(4.0);
  ObjectItem box;
  box.id = "box";
  box.size = {1.0, 1.0, 0.5};
  s.objects = {box};
  RobotItem flyer;
  flyer.kind = "flyer";
  flyer.id = "f";
  flyer.placement.p_W = {0.0, 0.0, 0.5};
  s.robots = {flyer};
  EXPECT_EQ(placed(s).robots.size(), 1U);
  s.robots[0].placement.p_W[2] = 0.45;
  EXPECT_THAT(problem_of(s), HasSubstr("robot 'f' overlaps box 'box'"));
  RobotItem walker;  // engines of the plane know no heights
  walker.kind = "e-puck";
  walker.id = "w";
  walker.placement.p_W = {0.0, 0.0, 0.8};
  s.robots = {walker};
  EXPECT_THAT(problem_of(s), HasSubstr("robot 'w' overlaps box 'box'"));
}

TEST(Placement, MixesSizes) {
  Scenario s = arena(10);
  RobotItem big = robots("big", uniform(20, 4));
  big.kind = "big";
  s.robots = {big, robots("ep", uniform(500, 4.9))};
  const auto r = placed(s).robots;
  for (std::size_t i = 0; i < r.size(); ++i) {
    for (std::size_t k = 0; k < i; ++k) {
      const double reach = (r[i].item == 0 ? 0.5 : kRadius_m) + (r[k].item == 0 ? 0.5 : kRadius_m);
      EXPECT_GE(std::hypot(r[i].x_m - r[k].x_m, r[i].y_m - r[k].y_m), reach - 1e-12);
    }
  }
}

// Huge things in a fine grid, and far away: neither slow nor wrong.
TEST(Placement, TakesHugeThings) {
  Scenario s = arena(1e6);
  s.objects = {box(2.5e5, 0, 4e5, 9e5), cylinder(-3e5, 0, 1e5), box(1e300, 1e300, 1, 1), box(0, 0, 1e6, 0.1)};
  ObjectItem slabs = box(0, 0, 3e5, 1e4);
  slabs.distribute = uniform(3, 4e5);
  s.objects.push_back(slabs);
  s.robots = {robot("clear", 1e4, 1e4), robots("ep", uniform(2000, 4.9e5))};
  const Placements p = placed(s);
  EXPECT_EQ(p.robots.size(), 2001U);
  expect_no_overlap(s, p);
}

TEST(Placement, APlaceInManyIsAsGoodAsAnyOther) {
  Scenario s = arena(40);
  s.robots = {robots("ep", uniform(20000, 19.8))};
  const auto r = placed(s).robots;
  std::set<std::pair<long, long>> cells;  // 1 m wide: every one of 39 x 39 inner cells has about 13
  for (const PlacedRobot& a : r) cells.emplace(std::lround(a.x_m), std::lround(a.y_m));
  EXPECT_GE(cells.size(), 39U * 39U);
}

}  // namespace
}  // namespace tandem::core
