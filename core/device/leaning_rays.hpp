// Level rays of one robot against an object that leans.
#pragma once
#include <array>

#include "core/device/ray_ring.hpp"
#include "core/space/attitude.hpp"

namespace tandem::core {

/// Shortens the distances of rays at this height of W, of a robot at (x, y) with this heading.
inline void meet_leaning(const RayRing& ring, const Object& shape, const std::array<double, 4>& q_WB, double height_m,
                         double x_m, double y_m, double cos_h, double sin_h, float* distances) noexcept {
  const Attitude attitude = attitude_of(shape, q_WB);
  for (std::size_t k = 0; k < ring.count; ++k) {
    const auto ox = static_cast<double>(ring.ox[k]);
    const auto oy = static_cast<double>(ring.oy[k]);
    const auto dx = static_cast<double>(ring.dx[k]);
    const auto dy = static_cast<double>(ring.dy[k]);
    const double far_m =
        meets_at(shape, attitude, {x_m + cos_h * ox - sin_h * oy, y_m + sin_h * ox + cos_h * oy, height_m},
                 {cos_h * dx - sin_h * dy, sin_h * dx + cos_h * dy, 0.0});
    if (far_m < static_cast<double>(distances[k])) distances[k] = static_cast<float>(far_m);
  }
}

}  // namespace tandem::core
