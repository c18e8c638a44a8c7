// Keeps a run in step with the wall clock, and keeps the ledger of how well that went.
//
//   slot        0         1         2         3         4         5
//   schedule    |---------|---------|---------|---------|---------|      start + slot / ticks_per_second, exactly
//   ticks       |#0##|    |#1############|#2#|         |#3##|           tick 1 misses its deadline; 2 starts at once;
//                                                                        3 is back on the schedule
#pragma once
#include <atomic>
#include <cstdint>

#include "hal/time.hpp"
#include "mixed_reality/time/histogram.hpp"
#include "mixed_reality/time/monotonic.hpp"

namespace tandem::mixed_reality {

/// Ledger of a paced run's deadlines.
struct PaceLedger {
  std::uint64_t ticks = 0;              ///< ended
  std::uint64_t deadline_misses = 0;    ///< ticks that ended after the next one should have begun
  std::uint64_t skipped_slots = 0;      ///< whole slots of the schedule in which no tick could begin
  hal::TimeNs largest_lateness_ns = 0;  ///< of the end of a tick, behind its deadline
  DurationHistogram wake_up;            ///< begin of a tick behind its place in the schedule, after a sleep
  DurationHistogram step;               ///< begin to end of a tick
};

/// Begins tick after tick on an absolute schedule. A tick that is late begins at once, and its lateness is not handed
/// on: the schedule never shifts. Whole slots that were missed are left out, not made up for: a burst of ticks would
/// drive real robots by poses that have not changed. After a stall the run is therefore behind the wall clock by
/// exactly `skipped_slots`. Nothing here allocates.
class Pacer {
 public:
  /// `time` must outlive the pacer. `ticks_per_second` is at least 1.
  Pacer(TimeSource& time, std::int64_t ticks_per_second);

  /// Puts slot 0 to now; the first tick begins with it.
  void start() noexcept;

  /// Ends the running tick, enters it in the ledger and sleeps until the next one is to begin.
  /// @returns false when `stop` became true, before or during the sleep: no further tick is to begin.
  bool wait_for_next(const std::atomic<bool>& stop) noexcept;
  /// Ends the running tick, enters it in the ledger, and begins no other.
  void finish() noexcept { (void)end_tick(); }

  /// When the running tick should have begun, and when it should end, on the time source's clock.
  hal::TimeNs scheduled_ns() const noexcept { return start_of(slot_); }
  hal::TimeNs deadline_ns() const noexcept { return start_of(slot_ + 1); }

  const PaceLedger& ledger() const noexcept { return ledger_; }

 private:
  hal::TimeNs end_tick() noexcept;
  hal::TimeNs start_of(std::int64_t slot) const noexcept {
    return start_ns_ + hal::time_of_tick(slot, ticks_per_second_);
  }
  std::int64_t slot_at(hal::TimeNs now_ns) const noexcept;

  TimeSource& time_;
  std::int64_t ticks_per_second_;
  hal::TimeNs start_ns_ = 0;
  hal::TimeNs began_ns_ = 0;
  std::int64_t slot_ = 0;
  PaceLedger ledger_;
};

}  // namespace tandem::mixed_reality
