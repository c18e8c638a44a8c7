// Clock that a live run keeps its speed by.
#pragma once
#include <chrono>
#include <condition_variable>
#include <cstdint>
#include <mutex>

#include "hal/time.hpp"

namespace tandem::core {

/// The steady clock of the system; tests have one of their own.
class LiveClock {
 public:
  virtual ~LiveClock() = default;
  virtual hal::TimeNs now_ns() noexcept {
    const auto now = std::chrono::steady_clock::now().time_since_epoch();
    return std::chrono::duration_cast<std::chrono::nanoseconds>(now).count();
  }
  /// Waits until `changed` is notified or until that time, whichever comes first; may return earlier.
  virtual void wait_until(std::unique_lock<std::mutex>& lock, std::condition_variable& changed, hal::TimeNs until_ns) {
    const std::chrono::nanoseconds left(until_ns - now_ns());
    if (left.count() > 0) changed.wait_for(lock, left);
  }
};

}  // namespace tandem::core
