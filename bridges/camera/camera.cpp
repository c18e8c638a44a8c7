#include "bridges/camera/camera.hpp"

#include <cmath>

namespace tandem::bridges::camera {
namespace {

struct Distorted {
  hal::Vector2 at;
  double xx, xy, yx, yy;  // derivatives
};

Distorted distorted(const Lens& lens, const hal::Vector2& d) noexcept {
  const auto& [k1, k2, p1, p2, k3] = lens.distortion;
  const double x = d.x(), y = d.y(), r2 = x * x + y * y;
  const double radial = 1.0 + r2 * (k1 + r2 * (k2 + r2 * k3));
  const double slope = 2.0 * (k1 + r2 * (2.0 * k2 + r2 * 3.0 * k3));  // of `radial`, by r2, twice
  return {{x * radial + 2.0 * p1 * x * y + p2 * (r2 + 2.0 * x * x),
           y * radial + p1 * (r2 + 2.0 * y * y) + 2.0 * p2 * x * y},
          radial + x * x * slope + 2.0 * p1 * y + 6.0 * p2 * x,
          x * y * slope + 2.0 * p1 * x + 2.0 * p2 * y,
          x * y * slope + 2.0 * p1 * x + 2.0 * p2 * y,
          radial + y * y * slope + 6.0 * p1 * y + 2.0 * p2 * x};
}

}  // namespace

hal::Vector2 pixel_of(const Lens& lens, const hal::Vector2& direction) noexcept {
  const hal::Vector2 at = distorted(lens, direction).at;
  return {lens.fx * at.x() + lens.cx, lens.fy * at.y() + lens.cy};
}

/// Newton's way, from the direction without distortion.
std::optional<hal::Vector2> direction_of(const Lens& lens, const hal::Vector2& pixel) noexcept {
  constexpr int kMostSteps = 30;
  constexpr double kNear = 1e-12;
  const hal::Vector2 wanted{(pixel.x() - lens.cx) / lens.fx, (pixel.y() - lens.cy) / lens.fy};
  hal::Vector2 d = wanted;
  for (int i = 0; i < kMostSteps; ++i) {
    const Distorted now = distorted(lens, d);
    const double determinant = now.xx * now.yy - now.xy * now.yx;
    if (!(determinant > 1e-3) || !(now.xx > 0.0)) return {};
    const hal::Vector2 error = now.at - wanted;
    const hal::Vector2 step{(now.yy * error.x() - now.xy * error.y()) / determinant,
                            (now.xx * error.y() - now.yx * error.x()) / determinant};
    d -= step;
    if (step.squaredNorm() < kNear * kNear) return d;
  }
  return {};
}

std::optional<hal::Vector2> pixel_of(const Camera& camera, const hal::Vector3& p_W) noexcept {
  const hal::Vector3 p_C = camera.place.q_WC.conjugate() * (p_W - camera.place.p_WC);
  if (!(p_C.z() > 1e-6)) return {};
  return pixel_of(camera.lens, hal::Vector2{p_C.x() / p_C.z(), p_C.y() / p_C.z()});
}

std::optional<hal::Vector2> on_plane(const Camera& camera, const hal::Vector2& pixel, double z_m) noexcept {
  const auto direction = direction_of(camera.lens, pixel);
  if (!direction) return {};
  const hal::Vector3 ray_W = camera.place.q_WC * hal::Vector3{direction->x(), direction->y(), 1.0};
  const double down_m = z_m - camera.place.p_WC.z();
  if (!(ray_W.z() * down_m > 1e-12)) return {};
  const double length = down_m / ray_W.z();
  return hal::Vector2{camera.place.p_WC.x() + length * ray_W.x(), camera.place.p_WC.y() + length * ray_W.y()};
}

std::optional<double> metres_a_pixel(const Camera& camera, const hal::Vector2& pixel, double z_m) noexcept {
  const auto at = on_plane(camera, pixel, z_m);
  const auto right = on_plane(camera, pixel + hal::Vector2{1.0, 0.0}, z_m);
  const auto down = on_plane(camera, pixel + hal::Vector2{0.0, 1.0}, z_m);
  if (!at || !right || !down) return {};
  const hal::Vector2 a = *right - *at, b = *down - *at;
  // The larger singular value of (a b).
  const double sum = a.squaredNorm() + b.squaredNorm(), product = a.x() * b.y() - a.y() * b.x();
  return std::sqrt(0.5 * (sum + std::sqrt(std::max(0.0, sum * sum - 4.0 * product * product))));
}

}  // namespace tandem::bridges::camera
