#include "mixed_reality/time/scheduling.hpp"

#include <algorithm>
#include <cstdlib>
#include <fcntl.h>
#include <pthread.h>
#include <signal.h>
#include <system_error>
#include <time.h>
#include <unistd.h>

#include "mixed_reality/time/monotonic.hpp"

namespace tandem::mixed_reality {

SystemScheduling::SystemScheduling() {
  due_ns_ = MonotonicTime().now_ns();
  try {
    thread_ = std::thread([this] { witness(); });
  } catch (const std::system_error&) {  // no more threads: then nobody witnesses
  }
}

SystemScheduling::~SystemScheduling() {
  end_ = true;
  if (thread_.joinable()) thread_.join();
  if (schedstat_ >= 0) ::close(schedstat_);
}

SchedulingLog::ThreadUse SystemScheduling::thread_use() noexcept {
  ThreadUse use;
  timespec t{};
  ::clock_gettime(CLOCK_THREAD_CPUTIME_ID, &t);
  use.ran_ns = static_cast<hal::TimeNs>(t.tv_sec) * hal::kNsPerSecond + t.tv_nsec;
  if (schedstat_ < 0) schedstat_ = ::open("/proc/thread-self/schedstat", O_RDONLY | O_CLOEXEC);
  std::array<char, 96> text{};
  const ssize_t size = schedstat_ >= 0 ? ::pread(schedstat_, text.data(), text.size() - 1, 0) : 0;
  if (size <= 0) return use;
  char* end = nullptr;
  (void)std::strtoll(text.data(), &end, 10);  // ran, but only up to the last tick of the kernel
  use.waited_ns = std::strtoll(end, nullptr, 10);
  return use;
}

void SystemScheduling::witness() noexcept {
  sigset_t all;
  sigfillset(&all);
  pthread_sigmask(SIG_BLOCK, &all, nullptr);
  MonotonicTime time;
  while (!end_.load(std::memory_order_relaxed)) {
    hal::TimeNs due_ns = 0;
    {
      const std::lock_guard lock(mutex_);
      due_ns = due_ns_ = time.now_ns() + kEvery_ns;
    }
    time.sleep_until(due_ns, end_);
    const hal::TimeNs woke_ns = time.now_ns();
    if (woke_ns - due_ns < kLate_ns) continue;
    const std::lock_guard lock(mutex_);
    stalls_[stall_count_++ % stalls_.size()] = {due_ns, woke_ns};
    due_ns_ = woke_ns;
  }
}

hal::TimeNs SystemScheduling::stalled_ns(hal::TimeNs from_ns, hal::TimeNs to_ns) noexcept {
  const auto within = [&](hal::TimeNs begin_ns, hal::TimeNs end_ns) {
    return std::max<hal::TimeNs>(0, std::min(end_ns, to_ns) - std::max(begin_ns, from_ns));
  };
  const std::lock_guard lock(mutex_);
  hal::TimeNs stalled_ns = 0;
  for (std::size_t i = 0; i < std::min(stall_count_, stalls_.size()); ++i)
    stalled_ns += within(stalls_[i].due_ns, stalls_[i].woke_ns);
  if (thread_.joinable() && to_ns - due_ns_ >= kLate_ns) stalled_ns += within(due_ns_, to_ns);  // it has not woken yet
  return stalled_ns;
}

}  // namespace tandem::mixed_reality
