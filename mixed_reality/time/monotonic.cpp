#include "mixed_reality/time/monotonic.hpp"

#include <cerrno>
#include <cstring>
#include <pthread.h>
#include <sched.h>
#include <time.h>

#include "hal/monotonic.hpp"

namespace tandem::mixed_reality {

hal::TimeNs MonotonicTime::now_ns() const noexcept {
  return hal::monotonic_ns();
}

void MonotonicTime::sleep_until(hal::TimeNs until_ns, const std::atomic<bool>& stop) noexcept {
  timespec t{};
  t.tv_sec = static_cast<time_t>(until_ns / hal::kNsPerSecond);
  t.tv_nsec = static_cast<long>(until_ns % hal::kNsPerSecond);
  while (!stop.load(std::memory_order_relaxed)) {
    if (clock_nanosleep(CLOCK_MONOTONIC, TIMER_ABSTIME, &t, nullptr) != EINTR) return;
  }
}

hal::Status ask_for_realtime_priority(int priority) {
  sched_param param{};
  param.sched_priority = priority;
  const int error = pthread_setschedparam(pthread_self(), SCHED_FIFO, &param);
  if (error == 0) return {};
  std::string message =
      "real-time priority " + std::to_string(priority) + " (SCHED_FIFO) was refused: " + std::strerror(error);
  if (error == EPERM)
    message += "; allow it with 'ulimit -r " + std::to_string(priority) + "' or the capability CAP_SYS_NICE";
  if (error == EINVAL) message += "; it goes from 1 to 99";
  return hal::Error{message};
}

}  // namespace tandem::mixed_reality
