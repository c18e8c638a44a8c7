// Finds where a camera hangs, from points whose places in the arena are known.
#pragma once
#include <string>
#include <vector>

#include "bridges/camera/camera.hpp"
#include "hal/result.hpp"

namespace tandem::bridges::calibration {

struct KnownPoint {
  std::string name;  ///< for messages
  hal::Vector3 p_W;
  hal::Vector2 pixel;
};

struct PlaceFit {
  camera::Placement place;
  double rms_px = 0.0;
  double sd_m = 0.0;     ///< of the camera's place: largest of its three
  std::string worst;     ///< the point that fits worst …
  double worst_m = 0.0;  ///< … and how far from its place it is seen
};

/// Points at nearly the same height. Errors: fewer than four, in a line, points that do not fit together.
hal::Result<PlaceFit> fit_place(const camera::Lens& lens, const std::vector<KnownPoint>& points);

}  // namespace tandem::bridges::calibration
