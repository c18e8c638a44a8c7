// Lines of sight among boxes, cylinders and bodies.
#pragma once
#include <algorithm>
#include <array>
#include <cmath>

#include "core/space/attitude.hpp"
#include "core/space/stores.hpp"

namespace tandem::core {

/// True when no box or cylinder stands between a and b (W). Cost grows with the distance, not with the number of
/// things.
inline bool in_sight(const SpaceStores& stores, double ax, double ay, double az, double bx, double by,
                     double bz) noexcept {
  if (stores.objects.empty()) return true;
  // A thing on the line lies within the index's reach of one of these points.
  const double length = std::sqrt((bx - ax) * (bx - ax) + (by - ay) * (by - ay));
  if (length < stores.static_index.clearance_m(ax, ay) && stores.movable_index.empty()) return true;
  const int hops = 1 + static_cast<int>(length / (1.9 * stores.static_index.reach()));
  const bool lean = anything_may_lean(stores);
  for (int i = 0; i < hops; ++i) {
    const double t = (i + 0.5) / hops;
    bool blocked = false;
    stores.for_each_object_near(ax + t * (bx - ax), ay + t * (by - ay), [&](const Object& object) {
      if (blocked) return;
      if (!lean || !leans(turn_of(stores, object))) {
        blocked = blocks(object, ax, ay, az, bx, by, bz);
        return;
      }
      const Attitude attitude = attitude_of(object, turn_of(stores, object));
      blocked = meets_at(object, attitude, {ax, ay, az}, {bx - ax, by - ay, bz - az}) <= 1.0;
    });
    if (blocked) return false;
  }
  return true;
}

/// Whether the line from a to b (W) passes through an upright disc around (cx, cy) between two heights.
inline bool disc_on_line(double cx, double cy, double radius_m, double low_m, double high_m,
                         const std::array<double, 3>& a, const std::array<double, 3>& b) noexcept {
  const double dx = b[0] - a[0];
  const double dy = b[1] - a[1];
  const double length2 = dx * dx + dy * dy;
  const double wx = cx - a[0];
  const double wy = cy - a[1];
  if (length2 == 0.0) {
    return wx * wx + wy * wy < radius_m * radius_m && std::min(a[2], b[2]) < high_m && std::max(a[2], b[2]) > low_m;
  }
  const double middle = (wx * dx + wy * dy) / length2;  // where the line is nearest to the centre: 0 at a, 1 at b
  const double aside2 = wx * wx + wy * wy - middle * middle * length2;
  if (aside2 >= radius_m * radius_m) return false;
  const double half = std::sqrt((radius_m * radius_m - aside2) / length2);
  const double enter = std::max(0.0, middle - half);
  const double leave = std::min(1.0, middle + half);
  if (enter >= leave) return false;
  const double z1 = a[2] + enter * (b[2] - a[2]);
  const double z2 = a[2] + leave * (b[2] - a[2]);
  return std::min(z1, z2) < high_m && std::max(z1, z2) > low_m;
}

inline double widest_body_m(const SpaceStores& stores) noexcept {
  double widest_m = 0.0;
  for (const RobotGroup& group : stores.groups) widest_m = std::max(widest_m, group.kind->body.radius_m);
  return widest_m;
}

/// Whether `blocks(row)` holds for any body, of a radius of at most `widest_m`, that the line from a to b (W) may
/// touch. Follows the line through the index: the cost grows with its length, not with the number of bodies.
template <class Blocks>
bool any_body_near_line(const SpaceStores& stores, double widest_m, const std::array<double, 3>& a,
                        const std::array<double, 3>& b, Blocks&& blocks) noexcept {
  const double dx = b[0] - a[0];
  const double dy = b[1] - a[1];
  const double length_m = std::sqrt(dx * dx + dy * dy);
  const int hops = 1 + static_cast<int>(length_m / (4.0 * widest_m));
  bool blocked = false;
  for (int i = 0; i < hops && !blocked; ++i) {
    const double t = (i + 0.5) / hops;
    stores.body_index.for_each_near(a[0] + t * dx, a[1] + t * dy, 0.5 * length_m / hops + widest_m,
                                    [&](const IndexEntry& o) { blocked = blocked || blocks(o.row()); });
  }
  return blocked;
}

}  // namespace tandem::core
