// Pose of a body in the plane, with the height of its base.
#pragma once
#include <cmath>

namespace tandem::hal {

/// Pose of a body B in W. The heading is kept as its cosine and sine.
struct Pose {
  double x_m = 0.0;
  double y_m = 0.0;
  double z_m = 0.0;    ///< of the base above the ground
  double cos_h = 1.0;  ///< heading: counter-clockwise from x
  double sin_h = 0.0;

  double heading_rad() const noexcept { return std::atan2(sin_h, cos_h); }  ///< in (-pi, pi]
  static Pose at(double x_m, double y_m, double heading_rad, double z_m = 0.0) noexcept {
    return {x_m, y_m, z_m, std::cos(heading_rad), std::sin(heading_rad)};
  }
};

}  // namespace tandem::hal
