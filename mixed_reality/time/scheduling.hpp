// How the system let this program run: evidence of whether a tick was late by our own work or by the machine's.
#pragma once
#include <array>
#include <atomic>
#include <condition_variable>
#include <cstddef>
#include <cstdint>
#include <mutex>
#include <thread>

#include "hal/time.hpp"

namespace tandem::mixed_reality {

/// Interface, so that tests fake it. `thread_use` is called from the thread that is judged alone.
class SchedulingLog {
 public:
  virtual ~SchedulingLog() = default;

  /// Of the calling thread since its start.
  struct ThreadUse {
    hal::TimeNs ran_ns = 0;
    hal::TimeNs waited_ns = 0;  ///< for a processor, while it could have run
  };
  virtual ThreadUse thread_use() noexcept = 0;
  /// How long a thread that has nearly nothing to do was kept from running between these times (CLOCK_MONOTONIC).
  virtual hal::TimeNs stalled_ns(hal::TimeNs from_ns, hal::TimeNs to_ns) noexcept = 0;
};

/// By the kernel's own account (/proc/thread-self/schedstat; where the kernel keeps none, no thread has waited), and by
/// a witness: a thread that wakes up every kEvery_ns and notes when it came kLate_ns or more too late.
class SystemScheduling final : public SchedulingLog {
 public:
  static constexpr hal::TimeNs kEvery_ns = 5 * hal::kNsPerMs;
  static constexpr hal::TimeNs kLate_ns = 2 * hal::kNsPerMs;

  SystemScheduling();
  ~SystemScheduling() override;
  SystemScheduling(const SystemScheduling&) = delete;
  SystemScheduling& operator=(const SystemScheduling&) = delete;

  ThreadUse thread_use() noexcept override;
  hal::TimeNs stalled_ns(hal::TimeNs from_ns, hal::TimeNs to_ns) noexcept override;

 private:
  struct Stall {
    hal::TimeNs due_ns = 0, woke_ns = 0;
  };
  void witness() noexcept;

  int schedstat_ = -1;  // of the thread that asked first
  std::mutex mutex_;
  std::array<Stall, 256> stalls_{};  // the newest ones
  std::size_t stall_count_ = 0;
  hal::TimeNs due_ns_ = 0;  // when it is to wake up next
  std::atomic<bool> end_{false};
  std::thread thread_;
};

}  // namespace tandem::mixed_reality
