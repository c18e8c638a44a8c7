// Homographies between a plane and pictures without distortion, and cameras from them [Hartley 2003].
#pragma once
#include <optional>
#include <span>
#include <vector>

#include "bridges/camera/camera.hpp"

namespace tandem::bridges::calibration {

/// A point of a plane and where it is seen.
struct Pair {
  hal::Vector2 plane, picture;
};

/// The matrix that takes (x, y, 1) of the plane to the picture. Nothing: fewer than four points, or they lie in a line.
std::optional<hal::Matrix3> homography(std::span<const Pair> pairs);

/// The camera that sees a plane at z = 0 through this homography, in the plane's frame; `h` leads to directions (x/z,
/// y/z). The camera is on the side of positive z.
camera::Placement placement_of(const hal::Matrix3& h);

/// The focal length that makes the planes' axes perpendicular and equally long, for square pixels; `all` lead to pixels
/// from the picture's centre. Nothing: the views do not tell.
std::optional<double> focal_of(std::span<const hal::Matrix3> all);

}  // namespace tandem::bridges::calibration
