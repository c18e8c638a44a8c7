// The clock of stamps and deadlines: it is never set, and starts anywhere.
#pragma once
#include <time.h>

#include "hal/time.hpp"

namespace tandem::hal {

/// CLOCK_MONOTONIC. Safe in signal handlers, and after a fork of a program with threads.
inline TimeNs monotonic_ns() noexcept {
  timespec t{};
  ::clock_gettime(CLOCK_MONOTONIC, &t);
  return TimeNs{t.tv_sec} * kNsPerSecond + TimeNs{t.tv_nsec};
}

}  // namespace tandem::hal
