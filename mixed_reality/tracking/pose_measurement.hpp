// One pose of a robot by a tracker, in the arena's frame and on this computer's clock.
#pragma once
#include <cstdint>
#include <optional>

#include "hal/time.hpp"

namespace tandem::mixed_reality {

/// One pose of a robot by a tracker.
struct PoseMeasurement {
  std::uint8_t tracker = 0;  ///< whose, below PoseFilter::kTrackers
  hal::TimeNs taken_ns = 0;  ///< when light, or whatever it was, left the robot; CLOCK_MONOTONIC
  double x_m = 0.0, y_m = 0.0;
  std::optional<double> heading_rad;  ///< nothing: the tracker sees a point
  double sd_m = 0.002;                ///< of each coordinate
  double sd_rad = 0.01;
  bool by_true_clock = false;  ///< its stamp is no estimate: the date, or CLOCK_MONOTONIC
};

}  // namespace tandem::mixed_reality
