// What a filter has learnt of a robot's wheels and of its trackers' clocks.
#pragma once
#include <array>
#include <cstddef>
#include <optional>

namespace tandem::mixed_reality {

/// Factors of the wheels' ways and of their distance, rad/s, s; and how well they are known.
struct LearntMotion {
  static constexpr std::size_t kTrackers = 4;
  double left = 1.0, right = 1.0, base = 1.0, bias_rad_s = 0.0;
  std::array<double, kTrackers> delay_s{};
  std::array<double, 4 + kTrackers> sd{};
  /// By which the body is later than the stamps of its encoders, and how well that is known (FusedPose); nothing: no
  /// tracker whose stamps are right has told it. It is then not in `delay_s` of these.
  std::optional<double> lag_s = {};
  double lag_sd_s = 0.0;
};

}  // namespace tandem::mixed_reality
