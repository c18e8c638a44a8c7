// Polygons in the plane: whether an outline is one, what is inside, how far its edge is.
#pragma once
#include <array>
#include <cstddef>
#include <limits>
#include <span>

namespace tandem::core {

using Point2 = std::array<double, 2>;

/// What makes an outline no polygon. `a` and `b` count its corners; a side begins at the corner of its number.
struct OutlineFlaw {
  enum class Kind { None, TooFew, TooMany, SameCorners, NoArea, FoldsBack, SidesMeet };
  static constexpr std::size_t kMostCorners = 1000;
  Kind kind = Kind::None;
  std::size_t a = 0, b = 0;
};
OutlineFlaw flaw_of(std::span<const Point2> corners) noexcept;

/// Whether a point is inside, whichever way around the corners go.
bool contains(std::span<const Point2> corners, double x, double y) noexcept;

/// The nearest point of the side from `a` to `b`.
Point2 nearest_on_side(const Point2& a, const Point2& b, double x, double y) noexcept;

/// The nearest point of a polygon's edge, and how far it is.
struct EdgePoint {
  double x = 0.0, y = 0.0;
  double distance = std::numeric_limits<double>::infinity();
};
EdgePoint nearest_on_edge(std::span<const Point2> corners, double x, double y) noexcept;

}  // namespace tandem::core
