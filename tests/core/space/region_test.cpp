#include "core/space/region.hpp"

#include <cmath>
#include <gtest/gtest.h>
#include <random>
#include <rapidcheck/gtest.h>

#include "core/space/object_index.hpp"
#include "core/space/region_map.hpp"

namespace tandem::core {
namespace {

Region polygon(const std::vector<std::pair<double, double>>& corners) {
  Region region;
  for (const auto& [x, y] : corners) region.sides.push_back({x, y, false, kNoRegion});
  region.close();
  return region;
}

Region rectangle(double x0, double y0, double x1, double y1) {
  return polygon({{x0, y0}, {x1, y0}, {x1, y1}, {x0, y1}});
}

/// A room with a dent from the east.
Region dented() {
  return polygon({{0, 0}, {4, 0}, {2, 1.5}, {4, 3}, {0, 3}});
}

TEST(Region, KnowsWhatLiesInIt) {
  const Region r = dented();
  EXPECT_TRUE(r.contains(1, 1));
  EXPECT_TRUE(r.contains(3, 0.5));
  EXPECT_FALSE(r.contains(3, 1.5));  // in the dent
  EXPECT_FALSE(r.contains(-0.1, 1));
  EXPECT_FALSE(r.contains(1, 3.1));
  EXPECT_FALSE(r.contains(NAN, 1));
  EXPECT_TRUE(Region{}.contains(1e9, -1e9));
}

TEST(Region, MeasuresTheWayToItsOutline) {
  const Region r = dented();
  EXPECT_EQ(r.distance(1, 1), 0.0);
  EXPECT_DOUBLE_EQ(r.distance(-2, 1), 2.0);
  EXPECT_DOUBLE_EQ(r.distance(-3, -4), 5.0);
  EXPECT_NEAR(r.distance(3, 1.5), 0.6, 1e-12);  // one from the tip of the dent, along a side of slope 3/4
}

TEST(Region, TurnsItsOutlineCounterClockwiseWithItsGates) {
  Region r;
  r.sides = {{0, 0, true, kNoRegion}, {0, 2, false, 7}, {3, 2, true, kNoRegion}, {3, 0, false, 9}};  // clockwise
  r.close();
  ASSERT_EQ(r.sides.size(), 4U);
  double twice_area = 0.0;
  for (std::size_t i = 0; i < 4; ++i) {
    const RegionSide& a = r.sides[i];
    const RegionSide& b = r.sides[(i + 1) % 4];
    twice_area += a.x_m * b.y_m - b.x_m * a.y_m;
    if (a.y_m == 2.0 && b.y_m == 2.0) {
      EXPECT_EQ(a.gate, 7);
    }
    if (a.y_m == 0.0 && b.y_m == 0.0) {
      EXPECT_EQ(a.gate, 9);
    }
    if (a.x_m == b.x_m) {
      EXPECT_TRUE(a.wall);
    }
  }
  EXPECT_DOUBLE_EQ(twice_area, 12.0);
  EXPECT_EQ(r.max_x_m, 3.0);
  EXPECT_EQ(r.min_y_m, 0.0);
}

TEST(Region, EveryPointOfASplitIsInExactlyOnePart) {
  EXPECT_TRUE(rc::check("also points on borders and corners", [](std::uint64_t seed, std::uint8_t c, std::uint8_t l) {
    const int columns = 1 + c % 5;
    const int lines = 1 + l % 5;
    std::vector<Region> parts;
    const auto at = [](int i, int n) { return -2.0 + 4.0 * i / n; };
    for (int y = 0; y < lines; ++y) {
      for (int x = 0; x < columns; ++x)
        parts.push_back(rectangle(at(x, columns), at(y, lines), at(x + 1, columns), at(y + 1, lines)));
    }
    std::mt19937_64 generator(seed);
    for (int i = 0; i < 200; ++i) {
      const bool on_x = generator() % 3 == 0;
      const bool on_y = generator() % 3 == 0;
      std::uniform_real_distribution<double> u(-1.999, 1.999);
      const double x =
          on_x ? at(static_cast<int>(generator() % static_cast<unsigned>(columns)), columns) : u(generator);
      const double y = on_y ? at(static_cast<int>(generator() % static_cast<unsigned>(lines)), lines) : u(generator);
      int in = 0;
      for (const Region& part : parts) in += part.contains(x, y) ? 1 : 0;
      const bool outermost = x <= -2.0 || y <= -2.0;
      RC_ASSERT(in == 1 || (outermost && in <= 1));
    }
  }));
}

TEST(Region, TouchesWhatReachesIntoIt) {
  const Region r = rectangle(0, 0, 2, 1);
  Object wall;  // long and thin, through the region, its centre far outside
  wall.x_m = 5.0;
  wall.y_m = 0.5;
  wall.half_x_m = 4.0;
  wall.half_y_m = 0.05;
  wall.z_high_m = 0.5;
  EXPECT_TRUE(r.touches(wall, 0.0));
  wall.half_x_m = 2.5;
  EXPECT_FALSE(r.touches(wall, 0.0));
  EXPECT_TRUE(r.touches(wall, 0.51));
  Object slab = wall;  // the region lies wholly inside it
  slab.x_m = 1.0;
  slab.half_x_m = slab.half_y_m = 10.0;
  EXPECT_TRUE(r.touches(slab, 0.0));
  Object bar = wall;  // across a corner, no corner of either inside the other
  bar.x_m = 0.0;
  bar.y_m = 0.0;
  bar.half_x_m = 3.0;
  bar.half_y_m = 0.01;
  bar.cos_h = std::cos(2.0);
  bar.sin_h = std::sin(2.0);
  EXPECT_TRUE(r.touches(bar, 0.0));
  Object post;
  post.kind = Object::Kind::Cylinder;
  post.x_m = 2.3;
  post.y_m = 0.5;
  post.radius_m = 0.29;
  post.z_high_m = 0.5;
  EXPECT_FALSE(r.touches(post, 0.0));
  post.radius_m = 0.31;
  EXPECT_TRUE(r.touches(post, 0.0));
}

TEST(RegionMap, AgreesWithTheOutlines) {
  EXPECT_TRUE(rc::check("against brute force, also beyond the arena", [](std::uint64_t seed) {
    std::mt19937_64 generator(seed);
    std::uniform_real_distribution<double> u(-1.0, 1.0);
    const double cut = 0.7 * u(generator);
    std::vector<Region> regions = {rectangle(-2, -2, cut, 2), rectangle(cut, -2, 2, 0.3), rectangle(cut, 0.3, 2, 2)};
    Region sky;
    sky.air = true;
    regions.push_back(sky);
    const double margin = 0.05 + 0.3 * std::fabs(u(generator));
    RegionMap map;
    map.build(regions, -2, -2, 2, 2, margin);
    for (int i = 0; i < 500; ++i) {
      const double x = 2.2 * u(generator);
      const double y = 2.2 * u(generator);
      const auto near = map.near(x, y);
      std::size_t on_ground = 0;
      for (std::size_t r = 0; r < regions.size(); ++r) {
        const bool is_near = regions[r].distance(x, y) <= margin;
        const bool listed = std::find(near.begin(), near.end(), r) != near.end();
        RC_ASSERT(listed || !is_near);
        on_ground += is_near && !regions[r].air ? 1 : 0;
      }
      for (std::uint16_t r = 0; r < 3; ++r) {
        if (map.deep_inside(r, x, y)) RC_ASSERT(regions[r].contains(x, y) && on_ground == 1U);
      }
      if (std::fabs(x) <= 2 && std::fabs(y) <= 2) RC_ASSERT(map.deep_inside(3, x, y));
    }
  }));
}

}  // namespace
}  // namespace tandem::core
