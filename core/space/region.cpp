#include "core/space/region.hpp"

#include <algorithm>
#include <cmath>

#include "core/space/object_index.hpp"

namespace tandem::core {

double distance_to_segment(double x, double y, double ax, double ay, double bx, double by, double& nearest_x,
                           double& nearest_y) noexcept {
  const double dx = bx - ax;
  const double dy = by - ay;
  const double length2 = dx * dx + dy * dy;
  const double t = length2 > 0.0 ? std::clamp(((x - ax) * dx + (y - ay) * dy) / length2, 0.0, 1.0) : 0.0;
  nearest_x = ax + t * dx;
  nearest_y = ay + t * dy;
  return std::hypot(x - nearest_x, y - nearest_y);
}

bool Region::contains(double x, double y) const noexcept {
  if (everywhere()) return true;
  if (!(x >= min_x_m && x <= max_x_m && y >= min_y_m && y <= max_y_m)) return false;
  // A ray to the east crosses the outline an odd number of times [Shimrat 1962]. Each side is half open, and taken from
  // its lower end, so that two regions decide alike about the side that they share.
  bool inside = false;
  for (std::size_t i = 0; i < sides.size(); ++i) {
    const RegionSide* a = &sides[i];
    const RegionSide* b = &sides[(i + 1) % sides.size()];
    if ((a->y_m > y) == (b->y_m > y)) continue;
    if (a->y_m > b->y_m) std::swap(a, b);
    const double cross_x = a->x_m + (y - a->y_m) / (b->y_m - a->y_m) * (b->x_m - a->x_m);
    if (x < cross_x) inside = !inside;
  }
  return inside;
}

double Region::distance(double x, double y) const noexcept {
  if (contains(x, y)) return 0.0;
  double nearest = std::numeric_limits<double>::infinity();
  for (std::size_t i = 0; i < sides.size(); ++i) {
    const RegionSide& a = sides[i];
    const RegionSide& b = sides[(i + 1) % sides.size()];
    double nx = 0.0;
    double ny = 0.0;
    nearest = std::min(nearest, distance_to_segment(x, y, a.x_m, a.y_m, b.x_m, b.y_m, nx, ny));
  }
  return nearest;
}

bool Region::touches(const Object& object, double margin_m) const noexcept {
  if (everywhere() || contains(object.x_m, object.y_m)) return true;
  if (distance(object.x_m, object.y_m) > object.reach_m() + margin_m) return false;
  // The object's outline and ours are near each other when a corner of one is near the other, or when sides cross.
  double nx = 0.0;
  double ny = 0.0;
  for (std::size_t i = 0; i < sides.size(); ++i) {
    const RegionSide& a = sides[i];
    const RegionSide& b = sides[(i + 1) % sides.size()];
    if (signed_distance(object, a.x_m, a.y_m, nx, ny) <= margin_m) return true;
    if (blocks(object, a.x_m, a.y_m, object.z_low_m, b.x_m, b.y_m, object.z_low_m)) return true;
  }
  if (object.kind == Object::Kind::Cylinder) return distance(object.x_m, object.y_m) <= object.radius_m + margin_m;
  for (const double sx : {-1.0, 1.0}) {
    for (const double sy : {-1.0, 1.0}) {
      const double x = object.x_m + sx * object.half_x_m * object.cos_h - sy * object.half_y_m * object.sin_h;
      const double y = object.y_m + sx * object.half_x_m * object.sin_h + sy * object.half_y_m * object.cos_h;
      if (distance(x, y) <= margin_m) return true;
    }
  }
  return false;
}

void Region::close() noexcept {
  if (everywhere()) return;
  double twice_area = 0.0;
  min_x_m = max_x_m = sides[0].x_m;
  min_y_m = max_y_m = sides[0].y_m;
  for (std::size_t i = 0; i < sides.size(); ++i) {
    const RegionSide& a = sides[i];
    const RegionSide& b = sides[(i + 1) % sides.size()];
    twice_area += a.x_m * b.y_m - b.x_m * a.y_m;
    min_x_m = std::min(min_x_m, a.x_m);
    max_x_m = std::max(max_x_m, a.x_m);
    min_y_m = std::min(min_y_m, a.y_m);
    max_y_m = std::max(max_y_m, a.y_m);
  }
  if (twice_area >= 0.0) return;
  // The other way round: what a side is belongs to the edge, which now starts at its other end.
  std::vector<RegionSide> turned(sides.size());
  for (std::size_t i = 0; i < sides.size(); ++i) {
    const std::size_t from = sides.size() - 1 - i;
    const RegionSide& edge = sides[(from + sides.size() - 1) % sides.size()];
    turned[i] = {sides[from].x_m, sides[from].y_m, edge.wall, edge.gate};
  }
  sides = std::move(turned);
}

}  // namespace tandem::core
