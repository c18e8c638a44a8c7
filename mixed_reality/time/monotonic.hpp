// Source of time of a paced run, and its waiting: behind an interface, so that tests fake both.
#pragma once
#include <atomic>

#include "hal/result.hpp"
#include "hal/time.hpp"

namespace tandem::mixed_reality {

/// A clock that never jumps. Called from the thread that paces the run.
class TimeSource {
 public:
  virtual ~TimeSource() = default;

  /// Nanoseconds since an arbitrary origin.
  virtual hal::TimeNs now_ns() const noexcept = 0;
  /// Returns at `until_ns` or later; at once when that has passed; earlier when `stop` becomes true.
  virtual void sleep_until(hal::TimeNs until_ns, const std::atomic<bool>& stop) noexcept = 0;
};

/// CLOCK_MONOTONIC, the clock that links stamp arriving bytes with.
class MonotonicTime final : public TimeSource {
 public:
  hal::TimeNs now_ns() const noexcept override;
  /// Sleeps to an absolute time, so that nothing adds up. A signal wakes it: `stop` is then looked at.
  void sleep_until(hal::TimeNs until_ns, const std::atomic<bool>& stop) noexcept override;
};

/// Gives the calling thread SCHED_FIFO with `priority` (1 to 99): wakes up in time also on a busy machine.
/// Error: not allowed here. The thread then goes on as it was; say so, and run.
hal::Status ask_for_realtime_priority(int priority);

}  // namespace tandem::mixed_reality
