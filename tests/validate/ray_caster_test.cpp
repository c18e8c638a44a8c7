#include "validate/ray_caster.hpp"

#include <cmath>
#include <gtest/gtest.h>

namespace tandem::validate {
namespace {

TEST(RayCaster, MeetsTheNearestFaceOfATurnedBox) {
  const Solids things{.boxes = {{2.0, 0.0, M_PI / 4, 1.0, 1.0, 0.0, 0.5}}, .cylinders = {}};
  EXPECT_NEAR(cast(things, 0.0, 0.0, 0.1, 0.0, 10.0), 2.0 - std::sqrt(0.5), 1e-12);  // its corner
  EXPECT_NEAR(cast(things, 0.0, 0.1, 0.1, 0.0, 10.0), 2.0 - std::sqrt(0.5) + 0.1, 1e-12);
  EXPECT_EQ(cast(things, 0.0, 0.0, 0.1, M_PI, 10.0), 10.0);
  EXPECT_EQ(cast(things, 0.0, 0.0, 0.6, 0.0, 10.0), 10.0);  // passes above
  EXPECT_EQ(cast(things, 0.0, 0.0, 0.1, 0.0, 1.0), 1.0);    // sees no farther
}

TEST(RayCaster, MeetsACylinderUnlessItIsTheRobotsOwn) {
  const Solids things{.boxes = {}, .cylinders = {{1.0, 0.0, 0.5, 0.0, 1.0, 3}}};
  EXPECT_NEAR(cast(things, 0.0, 0.3, 0.1, 0.0, 10.0), 1.0 - 0.4, 1e-12);  // 0.3, 0.4, 0.5
  EXPECT_EQ(cast(things, 0.0, 0.3, 0.1, 0.0, 10.0, 3), 10.0);
  EXPECT_EQ(cast(things, 1.1, 0.0, 0.1, 0.0, 10.0), 0.0);  // begins inside
  EXPECT_EQ(cast(things, 0.0, 0.51, 0.1, 0.0, 10.0), 10.0);
}

TEST(RayCaster, SeesOverAndPastSolidsButNotThroughThem) {
  const Solids things{.boxes = {{2.0, 0.0, M_PI / 4, 1.0, 1.0, 0.0, 0.5}}, .cylinders = {{0.0, 3.0, 0.5, 0.2, 1.0, 3}}};
  EXPECT_TRUE(blocked(things, {0.0, 0.0, 0.4}, {4.0, 0.0, 0.4}));
  EXPECT_TRUE(blocked(things, {0.0, 0.0, 0.9}, {4.0, 0.0, 0.0}));     // 0.45 high in its middle
  EXPECT_FALSE(blocked(things, {0.0, 0.0, 1.7}, {4.0, 0.0, 0.0}));    // 0.55 high where it leaves the box
  EXPECT_FALSE(blocked(things, {0.0, 0.0, 0.4}, {1.2, 0.0, 0.4}));    // ends before it
  EXPECT_FALSE(blocked(things, {0.0, 0.72, 0.4}, {4.0, 0.72, 0.4}));  // its corner is at 0.707
  EXPECT_TRUE(blocked(things, {0.0, 3.0, 1.5}, {0.0, 3.0, 0.5}));     // from above
  EXPECT_FALSE(blocked(things, {0.6, 3.0, 1.5}, {0.6, 3.0, 0.0}));
  EXPECT_FALSE(blocked(things, {-2.0, 3.0, 0.1}, {2.0, 3.0, 0.1}));  // beneath it
  EXPECT_FALSE(blocked(things, {-2.0, 3.0, 0.5}, {2.0, 3.0, 0.5}, 3));
}

}  // namespace
}  // namespace tandem::validate
