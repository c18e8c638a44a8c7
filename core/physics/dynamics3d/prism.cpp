#include "core/physics/dynamics3d/prism.hpp"

#include <algorithm>
#include <cmath>

namespace tandem::core {
namespace {

constexpr double kSameAxis_m = 1e-9;
constexpr std::array<std::array<double, 2>, 8> kRim = {{{1.0, 0.0},
                                                        {0.7071067811865476, 0.7071067811865476},
                                                        {0.0, 1.0},
                                                        {-0.7071067811865476, 0.7071067811865476},
                                                        {-1.0, 0.0},
                                                        {-0.7071067811865476, -0.7071067811865476},
                                                        {0.0, -1.0},
                                                        {0.7071067811865476, -0.7071067811865476}}};

/// The shortest way between two outlines seen from above.
struct Side {
  double gap_m;
  double nx, ny;  ///< from b to a
  double x_m, y_m;
};

Side between_discs(const Prism& a, const Prism& b, double direction_rad) noexcept {
  double nx = a.x_m - b.x_m;
  double ny = a.y_m - b.y_m;
  const double distance = std::sqrt(nx * nx + ny * ny);
  if (distance > kSameAxis_m) {
    nx /= distance;
    ny /= distance;
  } else {
    nx = std::cos(direction_rad);
    ny = std::sin(direction_rad);
  }
  const double gap = distance - a.radius_m - b.radius_m;
  const double middle = b.radius_m + 0.5 * gap;
  return {gap, nx, ny, b.x_m + middle * nx, b.y_m + middle * ny};
}

/// A point in a box's own frame.
std::array<double, 2> in_frame(const Prism& box, double x_m, double y_m) noexcept {
  const double dx = x_m - box.x_m;
  const double dy = y_m - box.y_m;
  return {box.cos_h * dx + box.sin_h * dy, box.cos_h * dy - box.sin_h * dx};
}

/// From the box to the disc.
Side from_box_to_disc(const Prism& box, const Prism& disc) noexcept {
  const auto [lx, ly] = in_frame(box, disc.x_m, disc.y_m);
  const double nearest_x = std::clamp(lx, -box.half_x_m, box.half_x_m);
  const double nearest_y = std::clamp(ly, -box.half_y_m, box.half_y_m);
  double nx = lx - nearest_x;
  double ny = ly - nearest_y;
  double distance = std::sqrt(nx * nx + ny * ny);
  double on_x = nearest_x;
  double on_y = nearest_y;
  if (distance > kSameAxis_m) {
    nx /= distance;
    ny /= distance;
  } else {  // the axis is inside: out through the nearest face
    const double inside_x = box.half_x_m - std::fabs(lx);
    const double inside_y = box.half_y_m - std::fabs(ly);
    const bool through_x = inside_x < inside_y;
    nx = through_x ? std::copysign(1.0, lx) : 0.0;
    ny = through_x ? 0.0 : std::copysign(1.0, ly);
    distance = -std::min(inside_x, inside_y);
    if (through_x)
      on_x = nx * box.half_x_m;
    else
      on_y = ny * box.half_y_m;
  }
  return {distance - disc.radius_m, box.cos_h * nx - box.sin_h * ny, box.sin_h * nx + box.cos_h * ny,
          box.x_m + box.cos_h * on_x - box.sin_h * on_y, box.y_m + box.sin_h * on_x + box.cos_h * on_y};
}

Side between(const Prism& a, const Prism& b, double direction_rad) noexcept {
  if (a.round && b.round) return between_discs(a, b, direction_rad);
  if (a.round) return from_box_to_disc(b, a);
  Side side = from_box_to_disc(a, b);
  side.nx = -side.nx;
  side.ny = -side.ny;
  return side;
}

bool covers(const Prism& shape, double x_m, double y_m) noexcept {
  if (shape.round) {
    const double dx = x_m - shape.x_m;
    const double dy = y_m - shape.y_m;
    return dx * dx + dy * dy <= shape.radius_m * shape.radius_m;
  }
  const auto [lx, ly] = in_frame(shape, x_m, y_m);
  return std::fabs(lx) <= shape.half_x_m && std::fabs(ly) <= shape.half_y_m;
}

/// Adds the corners, or points of the rim, of `shape` that `other` covers.
void add_covered(const Prism& shape, const Prism& other, const Touch& like, Touches& touches,
                 std::size_t& count) noexcept {
  const auto add = [&](double x, double y) {
    if (count == kMostTouches || !covers(other, x, y)) return;
    touches[count] = like;
    touches[count].p_m[0] = x;
    touches[count].p_m[1] = y;
    ++count;
  };
  if (shape.round) {
    for (const auto& [c, s] : kRim) add(shape.x_m + shape.radius_m * c, shape.y_m + shape.radius_m * s);
    return;
  }
  for (const double sx : {-1.0, 1.0}) {
    for (const double sy : {-1.0, 1.0}) {
      const double lx = sx * shape.half_x_m;
      const double ly = sy * shape.half_y_m;
      add(shape.x_m + shape.cos_h * lx - shape.sin_h * ly, shape.y_m + shape.sin_h * lx + shape.cos_h * ly);
    }
  }
}

}  // namespace

std::size_t find_touches(const Prism& a, const Prism& b, const TouchQuery& query, Touches& touches) noexcept {
  const double low_m = std::max(a.low_m, b.low_m);
  const double high_m = std::min(a.high_m, b.high_m);
  const double shared_m = high_m - low_m;  // negative: one is above the other
  if (shared_m < -query.near_m) return 0;
  const Side side = between(a, b, query.direction_rad);
  if (side.gap_m > query.near_m || (side.gap_m > 0.0 && shared_m <= 0.0)) return 0;

  const bool a_above = a.low_m + a.high_m > b.low_m + b.high_m;
  const Prism& upper = a_above ? a : b;
  const Prism& lower = a_above ? b : a;
  const bool on_top =
      !query.beside && side.gap_m < 0.0 && shared_m < -side.gap_m && upper.low_m > 0.5 * (lower.low_m + lower.high_m);
  if (on_top) {
    const Touch like{{0.0, 0.0, 0.5 * (low_m + high_m)}, {0.0, 0.0, a_above ? 1.0 : -1.0}, shared_m};
    std::size_t count = 0;
    add_covered(upper, lower, like, touches, count);
    add_covered(lower, upper, like, touches, count);
    if (count > 0) return count;
    touches[0] = like;
    touches[0].p_m[0] = side.x_m;
    touches[0].p_m[1] = side.y_m;
    return 1;
  }
  if (shared_m <= 0.0) return 0;
  const Touch beside{{side.x_m, side.y_m, 0.5 * (low_m + high_m)}, {side.nx, side.ny, 0.0}, -side.gap_m};
  touches[0] = beside;
  if (!query.line) return 1;
  touches[1] = beside;
  touches[0].p_m[2] = low_m;
  touches[1].p_m[2] = high_m;
  return 2;
}

}  // namespace tandem::core
