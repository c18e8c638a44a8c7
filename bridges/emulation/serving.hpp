// Loop of the servers of emulated robots and trackers: turns, waits, tells of faults and of how late it was itself.
#pragma once
#include <algorithm>
#include <atomic>
#include <optional>
#include <poll.h>
#include <utility>
#include <vector>

#include "bridges/emulation/event_log.hpp"
#include "bridges/link/link.hpp"

namespace tandem::bridges {

inline constexpr hal::TimeNs kStopNs = 20 * hal::kNsPerMs;  ///< the stop flag is looked at this often

/// A turn that begins so much later than it should have is told of: a real robot has its processor to itself.
inline constexpr hal::TimeNs kLateNs = 20 * hal::kNsPerMs;

/// Tells the event `late` with `by_ms`, if a turn that was due at `due` began only at `now`.
void tell_late(hal::TimeNs due, hal::TimeNs now, const EventSink& tell);

/// Calls `turn(now)`, `next_wake(now)` and then `wait(wake, now)` until `stop` is set or one of the statuses is an
/// error, which is then the result. Times are CLOCK_MONOTONIC. A turn that begins `kLateNs` or more after its wake
/// time, because the machine was busy or the turn before was long, is told of first (`tell_late`). Wake times are at
/// most `kStopNs` apart.
template <class Turn, class NextWake, class Wait>
hal::Status turn_until(const std::atomic<bool>& stop, const EventSink& tell, const Turn& turn,
                       const NextWake& next_wake, const Wait& wait) {
  hal::TimeNs due = monotonic_ns();
  while (!stop.load(std::memory_order_relaxed)) {
    const hal::TimeNs now = monotonic_ns();
    tell_late(due, now, tell);
    hal::Status status = turn(now);
    if (status.ok()) {
      due = std::max(now, next_wake(now));
      status = wait(due, now);
    }
    if (!status.ok()) return status;
  }
  tell_late(due, monotonic_ns(), tell);
  return {};
}

/// Until there is something to read, `at`, or a signal.
void wait_for(std::vector<pollfd>& polls, hal::TimeNs at, hal::TimeNs now);

/// Has `apply(change)`, a hal::Status, do what begins or ends by `now`, and tells of it: what the log says of an end
/// has come true.
template <class Plan, class Apply>
hal::Status apply_changes(Plan& faults, hal::TimeNs now, const EventSink& tell, const Apply& apply) {
  while (const auto change = faults.next_change(now)) {
    const auto note = [&](const char* phase) {
      tell(change->at, "fault", {{"fault", change->fault->text}, {"phase", phase}});
    };
    if (change->begins) note("begin");
    if (const hal::Status applied = apply(*change); !applied.ok()) return applied;
    if (!change->begins) note("end");
  }
  return {};
}

}  // namespace tandem::bridges
