// A camera: its lens, its place, and projection of points to pixels and back.
//
// Pixels count from the picture's upper left corner, x to the right, y down; the first pixel's centre is (0.5, 0.5).
// Frame C: x right, y down, z forward, out of the lens. W is the arena's frame.
#pragma once
#include <array>
#include <cstddef>
#include <optional>

#include "hal/vector.hpp"

namespace tandem::bridges::camera {

/// Pinhole with radial (k1, k2, k3) and tangential (p1, p2) distortion [Brown 1966], in the order k1, k2, p1, p2, k3.
struct Lens {
  std::size_t width = 0, height = 0;  ///< of pictures, in pixels
  double fx = 0.0, fy = 0.0;          ///< focal lengths, in pixels
  double cx = 0.0, cy = 0.0;          ///< where the axis meets the picture
  std::array<double, 5> distortion{};
};

/// Where a direction is seen: (x/z, y/z) in C to pixels.
hal::Vector2 pixel_of(const Lens& lens, const hal::Vector2& direction) noexcept;
/// The other way round. Nothing: the lens shows no direction there, or so far out that its polynomial turns back.
std::optional<hal::Vector2> direction_of(const Lens& lens, const hal::Vector2& pixel) noexcept;

struct Placement {
  hal::Quaternion q_WC = hal::Quaternion::Identity();
  hal::Vector3 p_WC = hal::Vector3::Zero();
};

struct Camera {
  Lens lens;
  Placement place;
  double residual_px = 0.0;  ///< of its calibration: RMS
};

/// Where a point of the arena is seen. Nothing: it is behind the camera.
std::optional<hal::Vector2> pixel_of(const Camera& camera, const hal::Vector3& p_W) noexcept;
/// The point so far above the floor that is seen there. Nothing: the ray does not meet that plane, or is none.
std::optional<hal::Vector2> on_plane(const Camera& camera, const hal::Vector2& pixel, double z_m) noexcept;
/// Metres a pixel, on that plane, in the worst direction. Nothing: as above.
std::optional<double> metres_a_pixel(const Camera& camera, const hal::Vector2& pixel, double z_m) noexcept;

}  // namespace tandem::bridges::camera
