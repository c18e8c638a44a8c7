// What controllers that were written for ARGoS 3 count in: the order of rings, the way from a place relative to the
// robot to one in the world. Scripts in Lua and sources in C++ share it.
#pragma once
#include <algorithm>
#include <array>
#include <cmath>
#include <cstddef>
#include <numbers>
#include <span>
#include <vector>

#include "hal/device/flight.hpp"
#include "hal/elementary.hpp"
#include "hal/robot_kind.hpp"

namespace tandem::hal::argos {

inline constexpr double kM_per_cm = 0.01;

/// Numbers of a ring's sensors in ARGoS' order: counter-clockwise from forward.
inline std::vector<std::size_t> counter_clockwise(std::span<const Mount> mounts) {
  constexpr double kTwoPi = 2.0 * std::numbers::pi;
  std::vector<std::size_t> order(mounts.size());
  for (std::size_t i = 0; i < order.size(); ++i) order[i] = i;
  const auto turn = [&](std::size_t i) {
    const double rad = std::fmod(mounts[i].bearing_rad, kTwoPi);
    return rad < 0.0 ? rad + kTwoPi : rad;
  };
  std::stable_sort(order.begin(), order.end(), [&](std::size_t a, std::size_t b) { return turn(a) < turn(b); });
  return order;
}

/// An angle in (-pi, pi].
inline double signed_angle(double rad) noexcept {
  constexpr double kTwoPi = 2.0 * std::numbers::pi;
  const double turn = std::fmod(rad, kTwoPi);
  return turn > std::numbers::pi ? turn - kTwoPi : turn <= -std::numbers::pi ? turn + kTwoPi : turn;
}

/// Heading of a robot's body in the world.
inline double yaw_of(const Positioning& at) noexcept {
  const auto& [w, x, y, z] = at.q_WB;
  return atan2(2.0 * (w * z + x * y), 1.0 - 2.0 * (y * y + z * z));
}
/// A place relative to the robot (x forward, y left), in the world.
inline std::array<double, 3> from_body(const Positioning& at, const std::array<double, 3>& p) noexcept {
  const double yaw = yaw_of(at), c = cos(yaw), s = sin(yaw);
  return {at.p_WB[0] + p[0] * c - p[1] * s, at.p_WB[1] + p[0] * s + p[1] * c, at.p_WB[2] + p[2]};
}

}  // namespace tandem::hal::argos
