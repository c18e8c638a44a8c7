// This computer as a run with real robots finds it: clocks, priority, load.
#pragma once
#include <string>

#include "hal/result.hpp"
#include "hal/time.hpp"
#include "mixed_reality/time/system_clock.hpp"

namespace tandem::mixed_reality {

struct Machine {
  std::string clock_source;  ///< "tsc"; empty: the system does not tell
  double load = 0.0;         ///< runnable threads of late (a minute), per processor; negative: unknown
  unsigned processors = 1;
  hal::Status priority;  ///< error: the real-time priority that was asked for is refused, and why
  SystemClock date;
};

/// Looks; `priority`: SCHED_FIFO that the experiment asks for, tried and put back; 0: none.
Machine look_at_machine(int priority);

}  // namespace tandem::mixed_reality
