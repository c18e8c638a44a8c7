#include <cmath>
#include <gtest/gtest.h>
#include <random>
#include <rapidcheck/gtest.h>
#include <set>

#include "core/space/body_index.hpp"
#include "core/space/object_index.hpp"

namespace tandem::core {
namespace {

struct Point {
  double x, y;
};

std::vector<Point> random_points(std::uint64_t seed, std::size_t n, double half) {
  std::mt19937_64 generator(seed);
  std::uniform_real_distribution<double> u(-half, half);
  std::vector<Point> points(n);
  for (Point& p : points) p = {u(generator), u(generator)};
  return points;
}

void rebuild(BodyIndex& index, const std::vector<Point>& points, ThreadPool& pool) {
  index.rebuild(
      points.size(), points.size(), pool,
      [&](std::size_t row) {
        return BodyIndex::Spot{points[row].x, points[row].y, true};
      },
      [&](std::size_t row) {
        return IndexEntry{points[row].x, points[row].y, 0.035F, static_cast<std::uint32_t>(row)};
      });
}

TEST(BodyIndex, FindsEveryBodyInReachAndNoneTwice) {
  EXPECT_TRUE(rc::check("against brute force, also beyond the area", [](std::uint64_t seed, std::uint16_t count) {
    const std::size_t n = count % 500;
    const auto points = random_points(seed, n, 3.0);  // the area is smaller
    ThreadPool pool(1, Assignment::Static);
    BodyIndex index;
    index.set_area(-2, -2, 2, 2, 0.2);
    rebuild(index, points, pool);
    for (std::size_t i = 0; i < n; i += 7) {
      for (const double reach : {0.05, 0.2, 1.3}) {
        std::set<std::uint32_t> found;
        index.for_each_near(points[i].x, points[i].y, reach,
                            [&](const IndexEntry& e) { RC_ASSERT(found.insert(e.row()).second); });
        for (std::size_t j = 0; j < n; ++j) {
          if (std::hypot(points[i].x - points[j].x, points[i].y - points[j].y) <= reach)
            RC_ASSERT(found.contains(static_cast<std::uint32_t>(j)));
        }
      }
    }
  }));
}

TEST(BodyIndex, IsTheSameForAnyNumberOfThreads) {
  const auto points = random_points(3, 20000, 10.0);
  const auto order_with = [&](std::size_t threads, Assignment assignment) {
    ThreadPool pool(threads, assignment);
    BodyIndex index;
    index.set_area(-10, -10, 10, 10, 0.2);
    std::vector<std::uint32_t> rows;
    for (int i = 0; i < 2; ++i) rebuild(index, points, pool);
    for (std::size_t i = 0; i < index.size(); ++i) rows.push_back(index.entries()[i].row());
    return rows;
  };
  const auto alone = order_with(1, Assignment::Static);
  for (const std::size_t threads : {2U, 3U, 5U}) {
    EXPECT_EQ(order_with(threads, Assignment::Static), alone);
    EXPECT_EQ(order_with(threads, Assignment::Dynamic), alone);
  }
}

Object box(double x, double y, double hx, double hy, double heading) {
  Object s;
  s.x_m = x;
  s.y_m = y;
  s.half_x_m = hx;
  s.half_y_m = hy;
  s.cos_h = std::cos(heading);
  s.sin_h = std::sin(heading);
  s.z_high_m = 0.5;
  return s;
}

TEST(ObjectIndex, KnowsNoThingNearerThanItsClearance) {
  EXPECT_TRUE(rc::check("against every thing, also beyond the area", [](std::uint64_t seed, std::uint8_t count) {
    std::vector<Object> shapes;
    for (const Point& p : random_points(seed, count % 9, 12.0))
      shapes.push_back(box(p.x, p.y, 0.05 + std::fabs(p.x) / 20.0, 0.05, p.y));
    ObjectIndex index;
    index.build(shapes, false, -10.0, -10.0, 10.0, 10.0, 0.2);
    double widest = 0.0;
    for (const Point& p : random_points(seed + 1, 200, 13.0)) {
      const double clear = index.clearance_m(p.x, p.y);
      double nearest = std::numeric_limits<double>::infinity();
      double nx = 0.0, ny = 0.0;
      for (const Object& s : shapes) nearest = std::min(nearest, signed_distance(s, p.x, p.y, nx, ny));
      RC_ASSERT(clear == 0.0 || nearest >= clear);
      widest = std::max(widest, clear);
    }
    RC_ASSERT(widest > 1.0);  // few things in much space: somewhere there is room
  }));
}

TEST(ObjectIndex, ListsEveryShapeWithinReach) {
  std::vector<Object> shapes;
  for (const Point& p : random_points(5, 60, 4.0)) shapes.push_back(box(p.x, p.y, 0.3, 0.05, p.x * 3));
  ObjectIndex index;
  index.build(shapes, false, -4, -4, 4, 4, 0.2);
  for (const Point& p : random_points(6, 3000, 4.5)) {
    const auto near = index.near(p.x, p.y);
    const std::set<std::uint32_t> listed(near.begin(), near.end());
    for (std::uint32_t i = 0; i < shapes.size(); ++i) {
      double nx = 0;
      double ny = 0;
      if (signed_distance(shapes[i], p.x, p.y, nx, ny) > 0.2) continue;
      EXPECT_TRUE(listed.contains(i)) << p.x << " " << p.y;
    }
  }
}

TEST(SignedDistance, IsNegativeInsideAndItsNormalPointsOut) {
  double nx = 0;
  double ny = 0;
  const Object s = box(1, 2, 0.5, 0.25, M_PI / 2);
  EXPECT_NEAR(signed_distance(s, 1.0, 2.6, nx, ny), 0.1, 1e-12);
  EXPECT_NEAR(ny, 1.0, 1e-12);
  EXPECT_NEAR(signed_distance(s, 1.2, 2.0, nx, ny), -0.05, 1e-12);
  EXPECT_NEAR(nx, 1.0, 1e-12);
  EXPECT_NEAR(signed_distance(s, 1.25 + 0.3, 2.5 + 0.4, nx, ny), 0.5, 1e-12);  // a corner
  EXPECT_NEAR(nx, 0.6, 1e-12);
}

TEST(Blocks, ALineThroughABoxOrACylinderButNotOverIt) {
  const Object b = box(0, 0, 0.1, 1.0, 0.0);
  EXPECT_TRUE(blocks(b, -1, 0, 0.1, 1, 0, 0.1));
  EXPECT_FALSE(blocks(b, -1, 0, 0.6, 1, 0, 0.6));
  EXPECT_FALSE(blocks(b, -1, 2, 0.1, 1, 2, 0.1));
  EXPECT_FALSE(blocks(b, -1, 0, 0.1, -0.2, 0, 0.1));
  Object c;
  c.kind = Object::Kind::Cylinder;
  c.radius_m = 0.2;
  c.z_high_m = 0.5;
  EXPECT_TRUE(blocks(c, -1, 0.19, 0.1, 1, 0.19, 0.1));
  EXPECT_FALSE(blocks(c, -1, 0.21, 0.1, 1, 0.21, 0.1));
}

}  // namespace
}  // namespace tandem::core
