// The clock that goes on while the machine sleeps: to notice such sleep.
#pragma once
#include <cstdint>
#include <time.h>

#include "hal/time.hpp"

namespace tandem::hal {

/// CLOCK_BOOTTIME. Safe in signal handlers, and after a fork of a program with threads.
inline TimeNs boottime_ns() noexcept {
  timespec t{};
  ::clock_gettime(CLOCK_BOOTTIME, &t);
  return TimeNs{t.tv_sec} * kNsPerSecond + TimeNs{t.tv_nsec};
}

/// The same in milliseconds, modulo 2^32 and never 0: for words that processes share.
inline std::uint32_t boottime_ms() noexcept {
  const auto ms = static_cast<std::uint32_t>(boottime_ns() / kNsPerMs);
  return ms != 0 ? ms : 1;
}

}  // namespace tandem::hal
