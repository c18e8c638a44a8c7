// Latency from an eye-bot's state report to the command that answers it, over LCM.
#pragma once
#include <cstdint>

#include "hal/result.hpp"

namespace tandem::bench {

struct SenseToActCase {
  std::int64_t robots = 20;
  double seconds = 5.0;    ///< that are timed, once all robots fly
  bool real_time = false;  ///< ask for SCHED_FIFO; else what the program has
};

/// Emulates the robots, which report 50 times a second, and drives each with a bridge that answers every report with
/// another velocity; both sides share this machine and its multicast on the loopback, not their threads or sockets.
/// Times are taken by the emulated robots: from when a report was handed to the system until the next command was
/// received. Prints one JSON object a line, `repeat` times. Errors: no route for multicast, no permission for
/// SCHED_FIFO, robots that do not take off.
hal::Status bench_sense_to_act(const SenseToActCase& c, std::int64_t repeat);

}  // namespace tandem::bench
