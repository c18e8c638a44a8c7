// Keeps a run in step with the wall clock, and keeps the ledger of how well that went.
//
//   slot        0         1         2         3         4         5
//   schedule    |---------|---------|---------|---------|---------|      start + slot / ticks_per_second, exactly
//   ticks       |#0##|    |#1############|#2#|         |#3##|           tick 1 misses its deadline; 2 starts at once;
//                                                                        3 is back on the schedule
#pragma once
#include <array>
#include <atomic>
#include <cstddef>
#include <cstdint>
#include <functional>

#include "hal/duration_histogram.hpp"
#include "hal/time.hpp"
#include "mixed_reality/time/monotonic.hpp"
#include "mixed_reality/time/scheduling.hpp"

namespace tandem::mixed_reality {

/// A tick that ended too late, and why.
struct MissedDeadline {
  std::uint64_t tick = 0;       ///< the first is 0
  hal::TimeNs lateness_ns = 0;  ///< of its end
  hal::TimeNs ran_ns = 0;       ///< its thread computed
  hal::TimeNs waited_ns = 0;    ///< its thread could have run, and got no processor, the wake-up before included
  hal::TimeNs stalled_ns = 0;   ///< the witness was kept from running meanwhile
  hal::TimeNs woke_late_ns = 0;
  /// Without what the machine kept from us (the largest of the three before) it would have been in time. That is handed
  /// on: a tick that begins late because of the one before is late by the same.
  bool by_machine = false;
};

/// Ledger of a paced run's deadlines.
struct PaceLedger {
  std::uint64_t ticks = 0;              ///< ended
  std::uint64_t deadline_misses = 0;    ///< ticks that ended after the next one should have begun
  std::uint64_t skipped_slots = 0;      ///< whole slots of the schedule in which no tick could begin
  hal::TimeNs largest_lateness_ns = 0;  ///< of the end of a tick, behind its deadline
  std::uint64_t misses_by_machine = 0;  ///< of `deadline_misses`; 0 without a judge (`Pacer::judge_by`)
  static constexpr std::size_t kKept = 32;
  std::array<MissedDeadline, kKept> first_misses{};  ///< as many as there are
  hal::DurationHistogram wake_up;  ///< begin of a tick behind its place in the schedule, after a sleep
  hal::DurationHistogram step;     ///< begin to end of a tick
};

/// Begins tick after tick on an absolute schedule. A tick that is late begins at once, and its lateness is not handed
/// on: the schedule never shifts. Whole slots that were missed are left out, not made up for: a burst of ticks would
/// drive real robots by poses that have not changed. After a stall the run is therefore behind the wall clock by
/// exactly `skipped_slots`. Nothing here allocates.
class Pacer {
 public:
  /// `time` must outlive the pacer. `ticks_per_second` is at least 1.
  Pacer(TimeSource& time, std::int64_t ticks_per_second);

  /// By whose doing deadlines are missed is told by this, which must outlive the pacer.
  void judge_by(SchedulingLog& scheduling) noexcept { scheduling_ = &scheduling; }

  /// Puts slot 0 to now; the first tick begins with it. From the thread that ticks.
  void start() noexcept;

  /// Called again and again while a pacer sleeps, so that what cannot wait for the next tick need not.
  struct Lookout {
    hal::TimeNs every_ns = 0;
    std::function<void()> look = {};
  };

  /// Ends the running tick, enters it in the ledger and sleeps until the next one is to begin.
  /// @returns false when `stop` became true, before or during the sleep: no further tick is to begin.
  bool wait_for_next(const std::atomic<bool>& stop) noexcept { return wait_for_next(stop, {}); }
  /// The same, and looks out meanwhile: at once, and then as often as it says.
  bool wait_for_next(const std::atomic<bool>& stop, const Lookout& lookout) noexcept;
  /// Ends the running tick, enters it in the ledger, and begins no other.
  void finish() noexcept { (void)end_tick(); }

  /// When the running tick should have begun, and when it should end, on the time source's clock.
  hal::TimeNs scheduled_ns() const noexcept { return start_of(slot_); }
  hal::TimeNs deadline_ns() const noexcept { return start_of(slot_ + 1); }

  const PaceLedger& ledger() const noexcept { return ledger_; }

 private:
  hal::TimeNs end_tick() noexcept;
  void note_miss(hal::TimeNs ended_ns, const SchedulingLog::ThreadUse& used) noexcept;
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
  SchedulingLog* scheduling_ = nullptr;  // null: unknown
  SchedulingLog::ThreadUse use_;         // when the last tick ended
  hal::TimeNs woke_late_ns_ = 0;         // before this tick
  hal::TimeNs handed_on_ns_ = 0;         // by which this tick began late, and the machine was the cause
};

}  // namespace tandem::mixed_reality
