#include "app/signals.hpp"

#include <csignal>

namespace tandem::app {
namespace {

std::atomic<bool> stop_asked{false};
std::atomic<bool> suspension_asked{false};
#if !defined(__ARM_ARCH) || __ARM_ARCH > 5  // ARMv5 stores a bool with one instruction, but promises nothing wider
static_assert(std::atomic<bool>::is_always_lock_free, "a signal handler may only touch lock-free atomics");
#endif

void note(int) {
  stop_asked.store(true, std::memory_order_relaxed);
}

void note_suspension(int) {
  suspension_asked.store(true, std::memory_order_relaxed);
}

}  // namespace

const std::atomic<bool>& catch_signals() {
  struct sigaction action {};
  action.sa_handler = &note;  // no SA_RESTART: sleeps wake up
  sigaction(SIGINT, &action, nullptr);
  sigaction(SIGTERM, &action, nullptr);
  return stop_asked;
}

std::atomic<bool>& suspend_asked() noexcept {
  return suspension_asked;
}

void catch_suspend() {
  struct sigaction action {};
  action.sa_handler = &note_suspension;
  action.sa_flags = SA_RESTART;
  sigaction(SIGTSTP, &action, nullptr);
}

void request_stop() noexcept {
  stop_asked.store(true, std::memory_order_relaxed);
}

}  // namespace tandem::app
