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

/// A stretch of a line, from 0 at its begin to 1 at its end; none where it is empty.
struct Stretch {
  double first = 0.0, last = 1.0;
  bool none() const { return first >= last; }
  /// Where p + t d lies between two values.
  void between(double p, double d, double low, double high) {
    if (d == 0.0) {
      if (p <= low || p >= high) last = first;
      return;
    }
    const double t1 = (low - p) / d, t2 = (high - p) / d;
    first = std::max(first, std::min(t1, t2));
    last = std::min(last, std::max(t1, t2));
  }
  /// Where p + t d is nearer to the origin than the radius.
  void within(Point p, Point d, double radius) {
    const double a = std::norm(d), b = p.real() * d.real() + p.imag() * d.imag(), c = std::norm(p) - radius * radius;
    if (a == 0.0 || b * b <= a * c) {
      if (a != 0.0 || c >= 0.0) last = first;
      return;
    }
    const double root = std::sqrt(b * b - a * c);
    first = std::max(first, (-b - root) / a);
    last = std::min(last, (-b + root) / a);
  }
};

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

bool blocked(const Solids& solids, const std::array<double, 3>& from, const std::array<double, 3>& to, std::size_t a,
             std::size_t b) {
  const Point begin{from[0], from[1]}, way{to[0] - from[0], to[1] - from[1]};
  const double rise = to[2] - from[2];
  for (const SolidBox& box : solids.boxes) {
    const Point back = std::polar(1.0, -box.angle_rad);
    const Point p = (begin - Point{box.x_m, box.y_m}) * back, d = way * back;
    Stretch inside;
    inside.between(from[2], rise, box.low_m, box.high_m);
    inside.between(p.real(), d.real(), -0.5 * box.size_x_m, 0.5 * box.size_x_m);
    inside.between(p.imag(), d.imag(), -0.5 * box.size_y_m, 0.5 * box.size_y_m);
    if (!inside.none()) return true;
  }
  for (const SolidCylinder& c : solids.cylinders) {
    if (c.owner != 0 && (c.owner == a || c.owner == b)) continue;
    Stretch inside;
    inside.between(from[2], rise, c.low_m, c.high_m);
    inside.within(begin - Point{c.x_m, c.y_m}, way, c.radius_m);
    if (!inside.none()) return true;
  }
  return false;
}

}  // namespace tandem::validate
