// The world of the robot's own positioning system, and the run's: one is turned about the vertical and shifted against
// the other.
#pragma once
#include <array>

namespace tandem::bridges::eyebot {

using Vector = std::array<double, 3>;
using Quaternion = std::array<double, 4>;  // w, x, y, z

/// `v`, expressed in the body, in the world that `q` turns the body's vectors into; `q` has length 1.
Vector turned(const Quaternion& q, const Vector& v) noexcept;

/// `v`, turned counter-clockwise.
Vector about_z(const Vector& v, double turn_rad) noexcept;

/// Pose of the robot's world in the run's. Both have z up.
struct WorldFrame {
  Vector origin{};        ///< of the robot's world, in the run's; m
  double turn_rad = 0.0;  ///< of the robot's x axis, counter-clockwise from the run's

  Vector place_in_run(const Vector& robots) const noexcept;
  Vector place_of_robot(const Vector& runs) const noexcept;
  Vector direction_in_run(const Vector& robots) const noexcept { return about_z(robots, turn_rad); }
  Vector direction_of_robot(const Vector& runs) const noexcept { return about_z(runs, -turn_rad); }
  /// `robots` need not have length 1 exactly, the result does.
  Quaternion orientation_in_run(const Quaternion& robots) const noexcept;
  /// In (-pi, pi].
  double heading_of_robot(double runs_rad) const noexcept;
};

}  // namespace tandem::bridges::eyebot
