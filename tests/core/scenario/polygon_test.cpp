#include "core/scenario/polygon.hpp"

#include <gtest/gtest.h>
#include <vector>

namespace tandem::core {
namespace {

using Corners = std::vector<Point2>;
const Corners kSquare = {{0, 0}, {1, 0}, {1, 1}, {0, 1}};
const Corners kHorseshoe = {{0, 0}, {3, 0}, {3, 3}, {2, 3}, {2, 1}, {1, 1}, {1, 3}, {0, 3}};

TEST(Polygon, AConcaveOneDoesNotContainItsBay) {
  EXPECT_TRUE(contains(kHorseshoe, 0.5, 2.0));
  EXPECT_TRUE(contains(kHorseshoe, 2.5, 2.0));
  EXPECT_TRUE(contains(kHorseshoe, 1.5, 0.5));
  EXPECT_FALSE(contains(kHorseshoe, 1.5, 2.0));
  EXPECT_FALSE(contains(kHorseshoe, -0.1, 2.0));
}

TEST(Polygon, IsTheSameWhicheverWayAroundItsCornersGo) {
  const Corners back(kHorseshoe.rbegin(), kHorseshoe.rend());
  for (double x = -0.45; x < 3.5; x += 0.2) {
    for (double y = -0.45; y < 3.5; y += 0.2) EXPECT_EQ(contains(kHorseshoe, x, y), contains(back, x, y)) << x << y;
  }
}

TEST(Polygon, ItsEdgeIsAsFarAsItsNearestSideOrCorner) {
  EXPECT_NEAR(nearest_on_edge(kSquare, 0.5, 0.2).distance, 0.2, 1e-12);
  EXPECT_NEAR(nearest_on_edge(kSquare, 1.3, 1.4).distance, 0.5, 1e-12);
  EXPECT_EQ(nearest_on_edge(kSquare, 1.3, 1.4).x, 1.0);
  EXPECT_NEAR(nearest_on_edge(kHorseshoe, 1.5, 2.0).distance, 0.5, 1e-12);
}

TEST(Polygon, SidesThatCrossTouchOrFoldMakeNone) {
  using Kind = OutlineFlaw::Kind;
  EXPECT_EQ(flaw_of(kSquare).kind, Kind::None);
  EXPECT_EQ(flaw_of(kHorseshoe).kind, Kind::None);
  EXPECT_EQ(flaw_of(Corners{{0, 0}, {1, 0}}).kind, Kind::TooFew);
  EXPECT_EQ(flaw_of(Corners(1001)).kind, Kind::TooMany);
  EXPECT_EQ(flaw_of(Corners{{0, 0}, {1, 0}, {1, 0}, {0, 1}}).kind, Kind::SameCorners);
  EXPECT_EQ(flaw_of(Corners{{0, 0}, {1, 1}, {2, 2}}).kind, Kind::NoArea);
  EXPECT_EQ(flaw_of(Corners{{0, 0}, {2, 0}, {1, 0}, {1, 1}}).kind, Kind::FoldsBack);
  const OutlineFlaw bow = flaw_of(Corners{{0, 0}, {1, 1}, {1, 0}, {0, 1}});
  EXPECT_EQ(bow.kind, Kind::SidesMeet);
  EXPECT_EQ(bow.a, 0U);
  EXPECT_EQ(bow.b, 2U);
}

}  // namespace
}  // namespace tandem::core
