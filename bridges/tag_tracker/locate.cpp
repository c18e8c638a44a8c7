#include "bridges/tag_tracker/locate.hpp"

#include <cmath>
#include <numbers>

namespace tandem::bridges::tag_tracker {
namespace {

constexpr double kCorner_px = 0.15;      // standard deviation of a corner, in focus and in good light
constexpr double kHeight_m = 0.001;      // of a tag's height: robots roll on small wheels
constexpr double kMount_rad = 0.002;     // of how level and how straight it was glued on
constexpr double kMostSizeError = 0.25;  // of what its side should be
constexpr double kMostShapeError = 0.2;  // RMS of its corners, likewise

}  // namespace

std::variant<Sighting, NoPose> locate(const camera::Camera& camera, const apriltag::Detection& tag, double size_m,
                                      double height_m) noexcept {
  std::array<hal::Vector2, 4> at;
  hal::Vector2 centre = hal::Vector2::Zero();
  for (std::size_t i = 0; i < 4; ++i) {
    const auto point = camera::on_plane(camera, tag.corners[i], height_m);
    if (!point) return NoPose::Outside;
    at[i] = *point;
    centre += 0.25 * at[i];
  }
  // The square, turned, that is nearest to the four: its upper edge to the x axis, its left one to the y axis.
  const double half_m = 0.5 * size_m;
  const std::array<hal::Vector2, 4> square = {hal::Vector2{-half_m, half_m}, hal::Vector2{-half_m, -half_m},
                                              hal::Vector2{half_m, -half_m}, hal::Vector2{half_m, half_m}};
  double along = 0.0, across = 0.0, squares = 0.0;
  for (std::size_t i = 0; i < 4; ++i) {
    const hal::Vector2 d = at[i] - centre;
    along += square[i].dot(d);
    across += square[i].x() * d.y() - square[i].y() * d.x();
    squares += d.squaredNorm();
  }
  const double norm = 2.0 * size_m * size_m;  // of the square's corners
  const double scale = std::hypot(along, across) / norm;
  const double rest_m2 = std::max(0.0, squares - scale * scale * norm) / 4.0;
  if (std::fabs(scale - 1.0) > kMostSizeError || rest_m2 > kMostShapeError * kMostShapeError * size_m * size_m)
    return NoPose::Misshapen;

  const auto pixel_m = camera::metres_a_pixel(camera, tag.centre(), height_m);
  if (!pixel_m) return NoPose::Outside;
  const hal::Vector2 from_camera = centre - hal::Vector2{camera.place.p_WC.x(), camera.place.p_WC.y()};
  const double lean = from_camera.norm() / std::fabs(camera.place.p_WC.z() - height_m);
  Sighting s;
  (void)s.set_name(std::to_string(tag.id));
  s.p_m = {centre.x(), centre.y(), height_m};
  s.heading_rad = std::atan2(across, along);
  s.sd_m = std::hypot(*pixel_m * std::hypot(0.5 * kCorner_px, camera.residual_px), kHeight_m * lean);
  s.sd_rad = std::hypot(*pixel_m * kCorner_px / (std::numbers::sqrt2 * size_m), kMount_rad);
  return s;
}

}  // namespace tandem::bridges::tag_tracker
