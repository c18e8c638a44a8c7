#include "bridges/eyebot/world_frame.hpp"

#include <cmath>

#include "hal/angle.hpp"

namespace tandem::bridges::eyebot {
namespace {

Vector turned_about_z(const Vector& v, double turn_rad) noexcept {
  const double c = std::cos(turn_rad), s = std::sin(turn_rad);
  return {c * v[0] - s * v[1], s * v[0] + c * v[1], v[2]};
}

}  // namespace

Vector WorldFrame::place_in_run(const Vector& robots) const noexcept {
  const Vector v = direction_in_run(robots);
  return {v[0] + origin[0], v[1] + origin[1], v[2] + origin[2]};
}

Vector WorldFrame::place_of_robot(const Vector& runs) const noexcept {
  return direction_of_robot({runs[0] - origin[0], runs[1] - origin[1], runs[2] - origin[2]});
}

Vector WorldFrame::direction_in_run(const Vector& robots) const noexcept {
  return turned_about_z(robots, turn_rad);
}

Vector WorldFrame::direction_of_robot(const Vector& runs) const noexcept {
  return turned_about_z(runs, -turn_rad);
}

Quaternion WorldFrame::orientation_in_run(const Quaternion& robots) const noexcept {
  const double length =
      std::sqrt(robots[0] * robots[0] + robots[1] * robots[1] + robots[2] * robots[2] + robots[3] * robots[3]);
  const double w = robots[0] / length, x = robots[1] / length, y = robots[2] / length, z = robots[3] / length;
  const double c = std::cos(0.5 * turn_rad), s = std::sin(0.5 * turn_rad);
  return {c * w - s * z, c * x - s * y, c * y + s * x, c * z + s * w};
}

double WorldFrame::heading_of_robot(double runs_rad) const noexcept {
  return hal::turn_between(turn_rad, runs_rad);
}

Vector turned(const Quaternion& q, const Vector& v) noexcept {
  // v + 2 u x (u x v + w v), where u is the vector part.
  const Vector u = {q[1], q[2], q[3]};
  const auto cross = [](const Vector& a, const Vector& b) {
    return Vector{a[1] * b[2] - a[2] * b[1], a[2] * b[0] - a[0] * b[2], a[0] * b[1] - a[1] * b[0]};
  };
  Vector inner = cross(u, v);
  for (std::size_t i = 0; i < 3; ++i) inner[i] += q[0] * v[i];
  const Vector outer = cross(u, inner);
  return {v[0] + 2.0 * outer[0], v[1] + 2.0 * outer[1], v[2] + 2.0 * outer[2]};
}

}  // namespace tandem::bridges::eyebot
