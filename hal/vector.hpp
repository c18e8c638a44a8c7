// Vectors and rotations of fixed size, in double precision (Eigen).
//
// They are not aligned beyond a double, so that they can stand in controllers, in snapshots and behind a plug-in's
// border whatever the compiler was told of the processor. Whoever links hal has EIGEN_DONT_VECTORIZE: vector
// instructions would add products in another order than a processor without them. Functions with sines and the like are
// made of hal/elementary.hpp. So results have the same bits everywhere.
#pragma once
#include <Eigen/Core>
#include <Eigen/Geometry>
#include <array>

#include "hal/elementary.hpp"

namespace tandem::hal {

using Vector2 = Eigen::Matrix<double, 2, 1, Eigen::DontAlign>;
using Vector3 = Eigen::Matrix<double, 3, 1, Eigen::DontAlign>;
using Matrix3 = Eigen::Matrix<double, 3, 3, Eigen::DontAlign>;
using Quaternion = Eigen::Quaternion<double, Eigen::DontAlign>;

/// From and to the arrays that ports, the space and messages have; quaternions are w, x, y, z there.
inline Vector3 vector_of(const std::array<double, 3>& a) noexcept {
  return {a[0], a[1], a[2]};
}
inline std::array<double, 3> array_of(const Vector3& v) noexcept {
  return {v.x(), v.y(), v.z()};
}
inline Quaternion quaternion_of(const std::array<double, 4>& a) noexcept {
  return {a[0], a[1], a[2], a[3]};
}
inline std::array<double, 4> array_of(const Quaternion& q) noexcept {
  return {q.w(), q.x(), q.y(), q.z()};
}

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

/// A turn about the vertical.
inline Quaternion about_z(double by_rad) noexcept {
  return {cos(0.5 * by_rad), 0.0, 0.0, sin(0.5 * by_rad)};
}

/// Heading of what is turned so: of its x axis, seen from above.
inline double heading_of(const Quaternion& q) noexcept {
  return atan2(2.0 * (q.w() * q.z() + q.x() * q.y()), 1.0 - 2.0 * (q.y() * q.y() + q.z() * q.z()));
}

}  // namespace tandem::hal
