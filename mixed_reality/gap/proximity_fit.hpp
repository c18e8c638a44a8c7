// Finds how a robot's proximity sensors read: the curve, the noise and the age of readings, against the distances that
// follow from the recorded poses.
#pragma once
#include <string>
#include <vector>

#include "hal/device/fitted.hpp"
#include "hal/device/ring_sensors.hpp"
#include "mixed_reality/gap/surroundings.hpp"
#include "mixed_reality/gap/wheel_fit.hpp"

namespace tandem::mixed_reality {

struct ProximityFit {
  std::string flaw;                                     ///< why nothing was found; empty: something was
  std::size_t readings = 0;                             ///< that were used
  Estimate gain, exponent, offset_m, noise_m, delay_s;  ///< as hal::ProximityModel
  hal::ProximityModel one_by_one;  ///< errors of each value if the others were known: what draws go by

  hal::ProximityModel values() const noexcept;
};

/// The distances that one robot's sensors should have read, tick after tick, and what they read.
struct ProximitySeries {
  std::size_t rays = 0;
  double range_m = 0.0;
  std::vector<double> distance_m;  ///< NaN: nothing that can be relied on
  std::vector<float> read_m;       ///< NaN: none
};

ProximitySeries proximity_series(const RecordedRun& run, std::size_t robot, const Surroundings& surroundings,
                                 const hal::ProximityPart& part);
ProximityFit fit_proximity(const ProximitySeries& series, double tick_s);

}  // namespace tandem::mixed_reality
