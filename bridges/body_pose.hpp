// Pose of a body on level ground, at a time.
#pragma once
#include "hal/time.hpp"

namespace tandem::bridges {

/// x east, y north, heading counter-clockwise from x.
struct BodyPose {
  double x_m = 0.0, y_m = 0.0, heading_rad = 0.0;
  hal::TimeNs taken_ns = 0;  ///< CLOCK_MONOTONIC
};

}  // namespace tandem::bridges
