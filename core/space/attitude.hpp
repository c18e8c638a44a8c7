// Boxes and cylinders that lean: where straight lines meet them, and what they cover seen from above.
#pragma once
#include <algorithm>
#include <array>
#include <cmath>
#include <limits>

#include "core/space/stores.hpp"

namespace tandem::core {

/// Axes of an object in W, and its middle. `z_low_m` of an object that leans is that of its middle less half its
/// height.
struct Attitude {
  std::array<std::array<double, 3>, 3> axes{};
  std::array<double, 3> middle_m{};
};

inline bool leans(const std::array<double, 4>& q_WB) noexcept {
  return std::fabs(q_WB[1]) + std::fabs(q_WB[2]) > 1e-6;
}

/// Whether anything may lean at all: an engine takes part that turns bodies in space.
inline bool anything_may_lean(const SpaceStores& stores) noexcept {
  return std::any_of(stores.regions.begin(), stores.regions.end(),
                     [](const Region& region) { return region.forces && !region.plane; });
}

inline Attitude attitude_of(const Object& o, const std::array<double, 4>& q) noexcept {
  Attitude a;
  a.axes[0] = {1.0 - 2.0 * (q[2] * q[2] + q[3] * q[3]), 2.0 * (q[1] * q[2] + q[0] * q[3]),
               2.0 * (q[1] * q[3] - q[0] * q[2])};
  a.axes[1] = {2.0 * (q[1] * q[2] - q[0] * q[3]), 1.0 - 2.0 * (q[1] * q[1] + q[3] * q[3]),
               2.0 * (q[2] * q[3] + q[0] * q[1])};
  a.axes[2] = {2.0 * (q[1] * q[3] + q[0] * q[2]), 2.0 * (q[2] * q[3] - q[0] * q[1]),
               1.0 - 2.0 * (q[1] * q[1] + q[2] * q[2])};
  a.middle_m = {o.x_m, o.y_m, 0.5 * (o.z_low_m + o.z_high_m)};
  return a;
}

/// Half the extent of an object along the axes of W.
inline std::array<double, 3> half_extents(const Object& o, const Attitude& a) noexcept {
  const double half_height_m = 0.5 * (o.z_high_m - o.z_low_m);
  std::array<double, 3> half{};
  for (std::size_t i = 0; i < 3; ++i) {
    const double up = a.axes[2][i];
    half[i] = half_height_m * std::fabs(up) +
              (o.kind == Object::Kind::Cylinder
                   ? o.radius_m * std::sqrt(std::max(0.0, 1.0 - up * up))
                   : o.half_x_m * std::fabs(a.axes[0][i]) + o.half_y_m * std::fabs(a.axes[1][i]));
  }
  return half;
}

/// How far along `way` (of any length: 1 is its end) a line from `from_m` meets the object first; 0 from within,
/// infinite where it does not.
inline double meets_at(const Object& o, const Attitude& a, const std::array<double, 3>& from_m,
                       const std::array<double, 3>& way) noexcept {
  constexpr double kNever = std::numeric_limits<double>::infinity();
  std::array<double, 3> p{};
  std::array<double, 3> d{};
  for (std::size_t axis = 0; axis < 3; ++axis) {
    for (std::size_t i = 0; i < 3; ++i) {
      p[axis] += a.axes[axis][i] * (from_m[i] - a.middle_m[i]);
      d[axis] += a.axes[axis][i] * way[i];
    }
  }
  double enter = 0.0;
  double leave = kNever;
  const auto between = [&](double at, double speed, double half) {
    if (std::fabs(speed) < 1e-15) {
      if (std::fabs(at) > half) leave = -1.0;
      return;
    }
    const double one = (-half - at) / speed;
    const double other = (half - at) / speed;
    enter = std::max(enter, std::min(one, other));
    leave = std::min(leave, std::max(one, other));
  };
  between(p[2], d[2], 0.5 * (o.z_high_m - o.z_low_m));
  if (o.kind == Object::Kind::Box) {
    between(p[0], d[0], o.half_x_m);
    between(p[1], d[1], o.half_y_m);
  } else {
    const double speed2 = d[0] * d[0] + d[1] * d[1];
    const double out = p[0] * p[0] + p[1] * p[1] - o.radius_m * o.radius_m;
    const double towards = p[0] * d[0] + p[1] * d[1];
    const double root2 = towards * towards - speed2 * out;
    if (speed2 < 1e-30) {
      if (out > 0.0) leave = -1.0;
    } else if (root2 < 0.0) {
      leave = -1.0;
    } else {
      enter = std::max(enter, (-towards - std::sqrt(root2)) / speed2);
      leave = std::min(leave, (-towards + std::sqrt(root2)) / speed2);
    }
  }
  return enter <= leave ? enter : kNever;
}

/// The attitude in the stores; upright where none is kept.
inline const std::array<double, 4>& turn_of(const SpaceStores& stores, const Object& object) noexcept {
  static constexpr std::array<double, 4> kUpright{1.0, 0.0, 0.0, 0.0};
  const auto number = static_cast<std::size_t>(&object - stores.objects.data());
  return number < stores.object_motion.size() ? stores.object_motion[number].q_WB : kUpright;
}

}  // namespace tandem::core
