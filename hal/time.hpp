// Time and ticks: integers only, so that nothing drifts.
#pragma once
#include <cstdint>

namespace tandem::hal {

/// Nanoseconds. Since the start of the run for readings and ticks; since an arbitrary origin for CLOCK_MONOTONIC
/// stamps.
using TimeNs = std::int64_t;

/// Number of a control step, 0 for the first.
using Tick = std::int64_t;

inline constexpr TimeNs kNsPerSecond = 1'000'000'000;
inline constexpr TimeNs kNsPerMs = 1'000'000;

/// Start of tick `tick` at `ticks_per_second`; exact for every tick, never accumulated.
constexpr TimeNs time_of_tick(Tick tick, std::int64_t ticks_per_second) noexcept {
  const Tick seconds = tick / ticks_per_second;
  const Tick rest = tick % ticks_per_second;
  return seconds * kNsPerSecond + rest * kNsPerSecond / ticks_per_second;
}

/// The double nearest to it: 300 ms is 0.3, which a multiplication by 1e-9 would miss.
constexpr double to_seconds(TimeNs t) noexcept {
  return static_cast<double>(t) / 1e9;
}

}  // namespace tandem::hal
