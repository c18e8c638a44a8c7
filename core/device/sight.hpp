// Lines of sight among boxes and cylinders.
#pragma once
#include "core/space/stores.hpp"

namespace tandem::core {

/// True when no box or cylinder stands between a and b (W). Cost grows with the distance, not with the number of
/// things.
inline bool in_sight(const SpaceStores& stores, double ax, double ay, double az, double bx, double by,
                     double bz) noexcept {
  if (stores.objects.empty()) return true;
  // A thing on the line lies within the index's reach of one of these points.
  const double length = std::sqrt((bx - ax) * (bx - ax) + (by - ay) * (by - ay));
  const int hops = 1 + static_cast<int>(length / (1.9 * stores.static_index.reach()));
  for (int i = 0; i < hops; ++i) {
    const double t = (i + 0.5) / hops;
    bool blocked = false;
    stores.for_each_object_near(ax + t * (bx - ax), ay + t * (by - ay), [&](const Object& object) {
      blocked = blocked || blocks(object, ax, ay, az, bx, by, bz);
    });
    if (blocked) return false;
  }
  return true;
}

}  // namespace tandem::core
