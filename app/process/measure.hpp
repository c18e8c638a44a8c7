// Measures the cost of a run: wall time, processor time, memory.
#pragma once
#include <ctime>
#include <sys/resource.h>

namespace tandem::app {

inline double seconds_of(clockid_t clock) noexcept {
  timespec t{};
  clock_gettime(clock, &t);
  return static_cast<double>(t.tv_sec) + 1e-9 * static_cast<double>(t.tv_nsec);
}
inline double wall_seconds() noexcept {
  return seconds_of(CLOCK_MONOTONIC);
}
/// User and system time of all threads of this process.
inline double cpu_seconds() noexcept {
  return seconds_of(CLOCK_PROCESS_CPUTIME_ID);
}

/// Largest resident set of this process so far, in MB (10^6 bytes).
inline double peak_rss_mb() noexcept {
  rusage usage{};
  getrusage(RUSAGE_SELF, &usage);
  return static_cast<double>(usage.ru_maxrss) * 1024e-6;
}

}  // namespace tandem::app
