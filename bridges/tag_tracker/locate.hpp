// Poses of tags from where a camera sees their corners.
#pragma once
#include <variant>

#include "bridges/apriltag/detector.hpp"
#include "bridges/camera/camera.hpp"
#include "bridges/tracker.hpp"

namespace tandem::bridges::tag_tracker {

enum class NoPose {
  Outside,   ///< a corner is seen where the lens shows nothing, or above the horizon
  Misshapen  ///< it is no level square of that size at that height: another size, another height, a tag that leans
};

/// A level tag, `size_m` along a side, `height_m` above the floor. Its heading is where its upper edge points. The
/// standard deviations are those of corners, calibration and height, at this place in the picture.
std::variant<Sighting, NoPose> locate(const camera::Camera& camera, const apriltag::Detection& tag, double size_m,
                                      double height_m) noexcept;

}  // namespace tandem::bridges::tag_tracker
