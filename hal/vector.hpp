// Vectors and rotations of fixed size, in double precision (Eigen), as hal/vector2.hpp has those of the plane.
#pragma once
#include <Eigen/Geometry>
#include <array>

#include "hal/vector2.hpp"

namespace tandem::hal {

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

/// A turn about the vertical.
inline Quaternion about_z(double by_rad) noexcept {
  return {cos(0.5 * by_rad), 0.0, 0.0, sin(0.5 * by_rad)};
}

/// Heading of what is turned so: of its x axis, seen from above.
inline double heading_of(const Quaternion& q) noexcept {
  return atan2(2.0 * (q.w() * q.z() + q.x() * q.y()), 1.0 - 2.0 * (q.y() * q.y() + q.z() * q.z()));
}

}  // namespace tandem::hal
