// The world of the robot's own positioning system, and the run's: one is turned about the vertical and shifted against
// the other.
#pragma once
#include <array>

#include "hal/angle.hpp"
#include "hal/vector.hpp"

namespace tandem::bridges::eyebot {

using Vector = std::array<double, 3>;
using Quaternion = std::array<double, 4>;  // w, x, y, z

/// `v`, expressed in the body, in the world that `q` turns the body's vectors into; `q` has length 1.
inline Vector turned(const Quaternion& q, const Vector& v) noexcept {
  return hal::array_of(hal::quaternion_of(q) * hal::vector_of(v));
}

/// `v`, turned counter-clockwise.
inline Vector about_z(const Vector& v, double turn_rad) noexcept {
  return hal::array_of(hal::about_z(turn_rad) * hal::vector_of(v));
}

/// Pose of the robot's world in the run's. Both have z up.
struct WorldFrame {
  Vector origin{};        ///< of the robot's world, in the run's; m
  double turn_rad = 0.0;  ///< of the robot's x axis, counter-clockwise from the run's

  Vector place_in_run(const Vector& robots) const noexcept {
    return hal::array_of(hal::vector_of(direction_in_run(robots)) + hal::vector_of(origin));
  }
  Vector place_of_robot(const Vector& runs) const noexcept {
    return direction_of_robot(hal::array_of(hal::vector_of(runs) - hal::vector_of(origin)));
  }
  Vector direction_in_run(const Vector& robots) const noexcept { return about_z(robots, turn_rad); }
  Vector direction_of_robot(const Vector& runs) const noexcept { return about_z(runs, -turn_rad); }
  /// `robots` need not have length 1 exactly, the result does.
  Quaternion orientation_in_run(const Quaternion& robots) const noexcept {
    return hal::array_of(hal::about_z(turn_rad) * hal::quaternion_of(robots).normalized());
  }
  /// In (-pi, pi].
  double heading_of_robot(double runs_rad) const noexcept { return hal::turn_between(turn_rad, runs_rad); }
};

}  // namespace tandem::bridges::eyebot
