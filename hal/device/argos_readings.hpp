// Readings as controllers know them that were written for ARGoS 3: order of rings, curves of infrared sensors, the way
// from a place relative to the robot to one in the world. Scripts in Lua and sources in C++ share them.
#pragma once
#include <algorithm>
#include <array>
#include <cmath>
#include <cstddef>
#include <numbers>
#include <span>
#include <string_view>
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

/// From a distance within the range to a reading, 0 to 1.
using Curve = double (*)(double distance_m) noexcept;

/// Of the rings of foot-bot and eye-bot: 1 at contact.
inline double ring_curve(double distance_m) noexcept {
  return distance_m < 0.009889556 ? 1.0 : 0.0100527 / (distance_m + 0.000163144);
}
/// Of the e-puck's ring, fitted by ARGoS' authors: 0 beyond 5 cm.
inline double epuck_curve(double distance_m) noexcept {
  if (distance_m > 0.05) return 0.0;
  return std::clamp((298.701 * distance_m - 36.8961) * distance_m + 1.08212, 0.0, 1.0);
}
/// Of the device that files name `proximity`.
inline double plain_curve(double distance_m) noexcept {
  return exp(-distance_m);
}
/// Of the device by the name that a file gives it.
inline Curve proximity_curve(std::string_view written) noexcept {
  return written == "proximity" ? &plain_curve : written == "epuck_proximity" ? &epuck_curve : &ring_curve;
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
