// The guardian process: stops every robot of a hub that died, froze, or left without their confirmation.
//
//   hub                                             guardian
//   heart: one beat every 20 ms  -- shared page -->  350 ms of silence, or 100 ms and the system says "stopped": frozen
//   claim, watch, release …      -- socket ------->  remembers how each robot is stopped; a lock file each
//   (dies)                       -- pidfd -------->  dead
//
//   dead or frozen  ->  it is the guardian's turn: every robot is ordered to stop at once, each by a thread of its own,
//                       until it confirms
//   frozen, and back ->  all are stopped once more, for what the hub may have written while it woke up; then it is the
//                       hub's turn again
#pragma once
#include <span>
#include <sys/types.h>

#include "bridges/guardian/pulse.hpp"
#include "bridges/guardian/shared_page.hpp"
#include "bridges/guardian/stopper.hpp"

namespace tandem::bridges::guardian {

/// Input of the guardian process at its start.
struct Inheritance {
  std::span<const StopperType> types;
  SharedPage* page = nullptr;
  int socket = -1;  ///< to the hub
  pid_t hub = 0;
  PulseLimits limits = {};
};

/// Runs in the child, right after the fork, and never returns. Closes all other descriptors; standard error is kept for
/// the one line that says which robot has not stopped.
[[noreturn]] void guard(const Inheritance& inheritance);

}  // namespace tandem::bridges::guardian
