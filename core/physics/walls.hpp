// Walls at the sides of regions.
#pragma once
#include <cmath>
#include <cstddef>
#include <utility>

#include "core/space/region.hpp"

namespace tandem::core {

/// How far a disc at (x, y) must go to be clear of its region's walls.
inline std::pair<double, double> out_of_walls(const Region& region, double x, double y, double radius_m) noexcept {
  double px = 0.0;
  double py = 0.0;
  for (std::size_t i = 0; i < region.sides.size(); ++i) {
    const RegionSide& a = region.sides[i];
    if (!a.wall) continue;
    const RegionSide& b = region.sides[(i + 1) % region.sides.size()];
    const double length = std::hypot(b.x_m - a.x_m, b.y_m - a.y_m);
    const double inward_x = -(b.y_m - a.y_m) / length;
    const double inward_y = (b.x_m - a.x_m) / length;
    double nx = 0.0;
    double ny = 0.0;
    const double d = distance_to_segment(x + px, y + py, a.x_m, a.y_m, b.x_m, b.y_m, nx, ny);
    if (d >= radius_m) continue;
    const double along_x = x + px - nx;
    const double along_y = y + py - ny;
    const double inside = along_x * inward_x + along_y * inward_y;
    const bool at_end = std::fabs(std::fabs(inside) - d) > 1e-9 * radius_m;
    if (at_end && d > 0.0) {  // round the wall's end
      px += along_x / d * (radius_m - d);
      py += along_y / d * (radius_m - d);
    } else {
      px += inward_x * (radius_m - inside);
      py += inward_y * (radius_m - inside);
    }
  }
  return {px, py};
}

}  // namespace tandem::core
