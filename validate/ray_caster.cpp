#include "validate/ray_caster.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <complex>

namespace tandem::validate {
namespace {

using Point = std::complex<double>;

double cross(Point a, Point b) {
  return a.real() * b.imag() - a.imag() * b.real();
}

/// Distance to the segment from `p` to `q`; infinite where the ray misses it.
double to_segment(Point from, Point along, Point p, Point q) {
  const Point side = q - p;
  const double bend = cross(along, side);
  if (bend == 0.0) return INFINITY;
  const double distance = cross(p - from, side) / bend;
  const double part = cross(p - from, along) / bend;
  return distance >= 0.0 && part >= 0.0 && part <= 1.0 ? distance : INFINITY;
}

double to_circle(Point from, Point along, Point middle, double radius) {
  const Point to = middle - from;
  const double ahead = to.real() * along.real() + to.imag() * along.imag();
  const double aside = cross(along, to);
  const double half = radius * radius - aside * aside;
  if (half < 0.0) return INFINITY;
  const double near = ahead - std::sqrt(half), far = ahead + std::sqrt(half);
  if (near >= 0.0) return near;
  return far >= 0.0 ? 0.0 : INFINITY;  // begins inside
}

}  // namespace

double cast(const Solids& solids, double x_m, double y_m, double z_m, double direction_rad, double range_m,
            std::size_t a, std::size_t b) {
  const Point from{x_m, y_m};
  const Point along = std::polar(1.0, direction_rad);
  double nearest = range_m;
  for (const SolidBox& box : solids.boxes) {
    if (z_m < box.low_m || z_m > box.high_m) continue;
    const Point ex = std::polar(0.5 * box.size_x_m, box.angle_rad);
    const Point ey = std::polar(0.5 * box.size_y_m, box.angle_rad + M_PI / 2.0);
    const Point middle{box.x_m, box.y_m};
    const std::array<Point, 4> corners = {middle + ex + ey, middle - ex + ey, middle - ex - ey, middle + ex - ey};
    for (std::size_t i = 0; i < 4; ++i)
      nearest = std::min(nearest, to_segment(from, along, corners[i], corners[(i + 1) % 4]));
  }
  for (const SolidCylinder& c : solids.cylinders) {
    if (z_m < c.low_m || z_m > c.high_m || (c.owner != 0 && (c.owner == a || c.owner == b))) continue;
    nearest = std::min(nearest, to_circle(from, along, {c.x_m, c.y_m}, c.radius_m));
  }
  return nearest;
}

}  // namespace tandem::validate
