// The response of infrared proximity sensors, forwards and backwards. Between its points it is straight.
#pragma once
#include <algorithm>
#include <span>

#include "hal/device/ring_sensors.hpp"

namespace tandem::hal {

/// Distance at which white paper gives `counts`: the response read backwards. `response` is that of a `ProximityPart`,
/// not empty. As few counts as its last point or fewer: that point's distance; as many as its first or more: that
/// one's.
inline double distance_m_of(std::span<const InfraredResponse> response, double counts) noexcept {
  if (!(counts > response.back().counts)) return response.back().distance_m;
  if (counts >= response.front().counts) return response.front().distance_m;
  const auto far = std::find_if(response.begin(), response.end(),
                                [&](const InfraredResponse& point) { return point.counts <= counts; });
  const auto near = far - 1;
  const double share = (counts - far->counts) / (near->counts - far->counts);
  return far->distance_m + share * (near->distance_m - far->distance_m);
}

/// The response read forwards: counts at `distance_m`; beyond the last point those of it.
inline double counts_at(std::span<const InfraredResponse> response, double distance_m) noexcept {
  if (!(distance_m < response.back().distance_m)) return response.back().counts;
  if (distance_m <= response.front().distance_m) return response.front().counts;
  const auto far = std::find_if(response.begin(), response.end(),
                                [&](const InfraredResponse& point) { return point.distance_m >= distance_m; });
  const auto near = far - 1;
  const double share = (distance_m - near->distance_m) / (far->distance_m - near->distance_m);
  return near->counts + share * (far->counts - near->counts);
}

}  // namespace tandem::hal
