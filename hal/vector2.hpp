// Vectors in the plane, in double precision (Eigen): what controllers on wheels compute with. hal/vector.hpp has more.
//
// They are not aligned beyond a double, so that they can stand in controllers, in snapshots and behind a plug-in's
// border whatever the compiler was told of the processor. Whoever links hal has EIGEN_DONT_VECTORIZE: vector
// instructions would add products in another order than a processor without them. Functions with sines and the like are
// made of hal/elementary.hpp. So results have the same bits everywhere.
#pragma once
#include <Eigen/Core>

#include "hal/elementary.hpp"

namespace tandem::hal {

using Vector2 = Eigen::Matrix<double, 2, 1, Eigen::DontAlign>;

/// The vector of this length that points to the bearing (counter-clockwise from x).
inline Vector2 polar(double length, double bearing_rad) noexcept {
  return {length * cos(bearing_rad), length * sin(bearing_rad)};
}

/// Direction of a vector, in [-pi, pi], counter-clockwise from x; 0 for no length.
inline double bearing_of(const Vector2& v) noexcept {
  return atan2(v.y(), v.x());
}

/// Its length, without overflow on the way.
inline double length_of(const Vector2& v) noexcept {
  return hypot(v.x(), v.y());
}

/// `v`, turned counter-clockwise.
inline Vector2 turned(const Vector2& v, double by_rad) noexcept {
  const double c = cos(by_rad);
  const double s = sin(by_rad);
  return {c * v.x() - s * v.y(), s * v.x() + c * v.y()};
}

}  // namespace tandem::hal
