// One moment on both clocks of a paced run.
#pragma once
#include "hal/time.hpp"

namespace tandem::mixed_reality {

/// The run's clock counts ticks: it stands still where slots of the schedule were left out. CLOCK_MONOTONIC never does,
/// so what real things did in the meantime is judged by that. A run-clock stamp is as old as its difference from
/// `run_ns`.
struct Moment {
  hal::TimeNs run_ns = 0;  ///< since the start of the run; of tick k exactly k / ticks_per_second
  hal::TimeNs monotonic_ns = 0;

  /// The CLOCK_MONOTONIC time of a stamp on the run's clock, and back.
  hal::TimeNs to_monotonic(hal::TimeNs taken_run_ns) const noexcept { return monotonic_ns - (run_ns - taken_run_ns); }
  hal::TimeNs to_run(hal::TimeNs taken_monotonic_ns) const noexcept {
    return run_ns - (monotonic_ns - taken_monotonic_ns);
  }
};

}  // namespace tandem::mixed_reality
