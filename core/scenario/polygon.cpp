#include "core/scenario/polygon.hpp"

#include <algorithm>
#include <cmath>

namespace tandem::core {
namespace {

/// Positive when c lies to the left of the line from a to b.
double side_of(const Point2& a, const Point2& b, const Point2& c) noexcept {
  return (b[0] - a[0]) * (c[1] - a[1]) - (b[1] - a[1]) * (c[0] - a[0]);
}

bool cross(const Point2& a, const Point2& b, const Point2& c, const Point2& d) noexcept {
  return side_of(a, b, c) * side_of(a, b, d) < 0.0 && side_of(c, d, a) * side_of(c, d, b) < 0.0;
}

/// Whether c lies on the side from a to b.
bool lies_on(const Point2& a, const Point2& b, const Point2& c) noexcept {
  return side_of(a, b, c) == 0.0 && (c[0] - a[0]) * (c[0] - b[0]) <= 0.0 && (c[1] - a[1]) * (c[1] - b[1]) <= 0.0;
}

bool meet(const Point2& a, const Point2& b, const Point2& c, const Point2& d) noexcept {
  return cross(a, b, c, d) || lies_on(a, b, c) || lies_on(a, b, d) || lies_on(c, d, a) || lies_on(c, d, b);
}

/// Whether the side from b to c goes back along the one from a to b.
bool folds_back(const Point2& a, const Point2& b, const Point2& c) noexcept {
  return side_of(a, b, c) == 0.0 && (b[0] - a[0]) * (c[0] - b[0]) + (b[1] - a[1]) * (c[1] - b[1]) < 0.0;
}

}  // namespace

OutlineFlaw flaw_of(std::span<const Point2> corners) noexcept {
  using Kind = OutlineFlaw::Kind;
  const std::size_t count = corners.size();
  if (count < 3) return {Kind::TooFew};
  if (count > OutlineFlaw::kMostCorners) return {Kind::TooMany};
  for (std::size_t i = 0; i < count; ++i) {
    if (corners[i] == corners[(i + 1) % count]) return {Kind::SameCorners, i, (i + 1) % count};
  }
  if (std::all_of(corners.begin() + 2, corners.end(),
                  [&](const Point2& c) { return side_of(corners[0], corners[1], c) == 0.0; }))
    return {Kind::NoArea};
  for (std::size_t i = 0; i < count; ++i) {
    const Point2& a = corners[i];
    const Point2& b = corners[(i + 1) % count];
    if (folds_back(a, b, corners[(i + 2) % count])) return {Kind::FoldsBack, (i + 1) % count, i};
    for (std::size_t k = i + 2; k < count; ++k) {
      const std::size_t next = (k + 1) % count;
      if (next != i && meet(a, b, corners[k], corners[next])) return {Kind::SidesMeet, i, k};
    }
  }
  return {};
}

bool contains(std::span<const Point2> corners, double x, double y) noexcept {
  bool inside = false;
  for (std::size_t i = 0, k = corners.size() - 1; i < corners.size(); k = i++) {
    const Point2& a = corners[i];
    const Point2& b = corners[k];
    if ((a[1] > y) != (b[1] > y) && x < (b[0] - a[0]) * (y - a[1]) / (b[1] - a[1]) + a[0]) inside = !inside;
  }
  return inside;
}

Point2 nearest_on_side(const Point2& a, const Point2& b, double x, double y) noexcept {
  const double along_x = b[0] - a[0], along_y = b[1] - a[1];
  const double length2 = along_x * along_x + along_y * along_y;
  if (!(length2 > 0.0)) return a;
  const double part = std::clamp(((x - a[0]) * along_x + (y - a[1]) * along_y) / length2, 0.0, 1.0);
  return {a[0] + part * along_x, a[1] + part * along_y};
}

EdgePoint nearest_on_edge(std::span<const Point2> corners, double x, double y) noexcept {
  EdgePoint nearest;
  for (std::size_t i = 0, k = corners.size() - 1; i < corners.size(); k = i++) {
    const Point2 p = nearest_on_side(corners[k], corners[i], x, y);
    const double distance = std::sqrt((p[0] - x) * (p[0] - x) + (p[1] - y) * (p[1] - y));
    if (distance < nearest.distance) nearest = {p[0], p[1], distance};
  }
  return nearest;
}

}  // namespace tandem::core
