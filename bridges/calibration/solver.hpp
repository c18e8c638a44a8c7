// Least squares by Levenberg and Marquardt, for lenses and places: dense normal equations, derivatives by differences.
#pragma once
#include <Eigen/Core>
#include <span>
#include <vector>

#include "bridges/camera/camera.hpp"

namespace tandem::bridges::calibration {

/// A point that lies still in the frame of its view, and where that view sees it.
struct Observation {
  std::size_t view = 0;
  hal::Vector3 p;
  hal::Vector2 pixel;
};

struct Problem {
  camera::Lens lens;
  bool lens_known = false;  ///< only the places are looked for
  bool k3_too = false;      ///< the third radial coefficient is looked for, too; else it stays
  std::vector<camera::Placement> views;
  std::vector<Observation> observations;
};

struct Solution {
  bool converged = false;
  double rms_px = 0.0;  ///< of distances
  std::vector<double> view_rms_px;
  Eigen::VectorXd sd;  ///< of fx, fy, cx, cy, the distortion (k3 where it was looked for), then of each
                       ///< view's turn and place, all as far as they were looked for
};

/// Improves the problem's lens and places. Points whose distance is more than a pixel weigh less (Huber).
Solution solve(Problem& problem);

}  // namespace tandem::bridges::calibration
