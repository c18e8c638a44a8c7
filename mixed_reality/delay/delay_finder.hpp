// Finds, while a robot drives, how much later than its commands its counters show them.
#pragma once
#include <algorithm>
#include <array>
#include <cmath>
#include <cstddef>

#include "mixed_reality/delay/commands.hpp"
#include "mixed_reality/delay/delays.hpp"

namespace tandem::mixed_reality {

/// Compares what counters said between two stamps with what was commanded so long before, for a row of delays: least
/// squares over the last few hundred readings. Told from when commands have changed often enough. Allocates nothing.
class DelayFinder {
 public:
  static constexpr std::size_t kDelays = 41;
  static constexpr hal::TimeNs kStep_ns = 10 * hal::kNsPerMs;
  static constexpr double kMemory = 300.0;     ///< readings
  static constexpr double kFewest = 20.0;      ///< readings
  static constexpr double kKnown_s = 0.006;    ///< standard deviation from which it is believed
  static constexpr double kSmallest_m = 1e-5;  ///< of a reading's error: counters are rounded, stamps jitter

  /// The wheels counted so much between the stamps `from` and `until`.
  void note(const CommandHistory& commands, hal::TimeNs from, hal::TimeNs until, double left_m,
            double right_m) noexcept {
    constexpr double kKeep = 1.0 - 1.0 / kMemory;
    count_ = kKeep * count_ + 1.0;
    for (std::size_t k = 0; k < kDelays; ++k) {
      const hal::TimeNs delay_ns = static_cast<hal::TimeNs>(k) * kStep_ns;
      const WheelWays told = commands.ways(from - delay_ns, until - delay_ns);
      const double left = left_m - told.left_m, right = right_m - told.right_m;
      squares_[k] = kKeep * squares_[k] + left * left + right * right;
    }
  }

  /// From a command until the stamps of counters that show it.
  DelayEstimate estimate() const noexcept {
    const auto least = static_cast<std::size_t>(std::min_element(squares_.begin(), squares_.end()) - squares_.begin());
    if (count_ < kFewest || least + 1 == kDelays) return {};
    const std::size_t middle = std::max<std::size_t>(1, least);
    const double before = squares_[middle - 1], after = squares_[middle + 1];
    const double curvature = before - 2.0 * squares_[middle] + after;
    if (!(curvature > 0.0)) return {};
    const double step_s = hal::to_seconds(kStep_ns);
    const double variance = std::max(squares_[least] / (2.0 * count_), kSmallest_m * kSmallest_m);
    const double sd_s = std::sqrt(2.0 * variance / curvature) * step_s;
    const double off = 0.5 * (before - after) / curvature;
    return {std::max(0.0, (static_cast<double>(middle) + off) * step_s), 1.96 * sd_s, sd_s < kKnown_s};
  }

 private:
  std::array<double, kDelays> squares_{};
  double count_ = 0.0;
};

}  // namespace tandem::mixed_reality
