// What the servers of emulated robots do alike: turn, wait, and tell of faults.
#pragma once
#include <atomic>
#include <optional>
#include <poll.h>
#include <utility>
#include <vector>

#include "bridges/emulation/event_log.hpp"
#include "bridges/link/link.hpp"

namespace tandem::bridges {

inline constexpr hal::TimeNs kStopNs = 20 * hal::kNsPerMs;  ///< the stop flag is looked at this often

/// Calls `turn(now)` and then `wait(now)`, both a hal::Status, until `stop` is set or one fails, which is then the
/// result. Times are CLOCK_MONOTONIC.
template <class Turn, class Wait>
hal::Status turn_until(const std::atomic<bool>& stop, const Turn& turn, const Wait& wait) {
  while (!stop.load(std::memory_order_relaxed)) {
    const hal::TimeNs now = monotonic_ns();
    hal::Status status = turn(now);
    if (status.ok()) status = wait(now);
    if (!status.ok()) return status;
  }
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
