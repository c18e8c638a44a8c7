#include "app/process/signals.hpp"

#include <cerrno>
#include <csignal>

#include "app/process/terminal.hpp"

namespace tandem::app {
namespace {

std::atomic<bool> stop_asked{false};
std::atomic<bool> suspension_asked{false};
std::atomic<bool> has_continued{false};
std::atomic<int> stop_signal{0};  // the first one
std::atomic<bool> rearming_asked{false};
#if !defined(__ARM_ARCH) || __ARM_ARCH > 5  // ARMv5 stores a bool with one instruction, but promises nothing wider
static_assert(std::atomic<bool>::is_always_lock_free, "a signal handler may only touch lock-free atomics");
#endif

void note(int signal) {
  int none = 0;
  stop_signal.compare_exchange_strong(none, signal, std::memory_order_relaxed);
  stop_asked.store(true, std::memory_order_relaxed);
}

void note_suspension(int) {
  leave_screen_now();
  suspension_asked.store(true, std::memory_order_relaxed);
}

void suspend_now(int) {
  const int error = errno;
  leave_screen_now();
  raise(SIGSTOP);  // all threads
  errno = error;
}

void note_continuation(int) {
  has_continued.store(true, std::memory_order_relaxed);
}

void note_rearm(int) {
  rearming_asked.store(true, std::memory_order_relaxed);
}

}  // namespace

const std::atomic<bool>& catch_signals() {
  struct sigaction action {};
  action.sa_handler = &note;  // no SA_RESTART: sleeps wake up
  for (const int signal : {SIGINT, SIGTERM, SIGHUP, SIGQUIT, SIGXCPU, SIGALRM}) {
    struct sigaction before {};
    sigaction(signal, nullptr, &before);
    if (signal == SIGHUP && before.sa_handler == SIG_IGN) continue;  // nohup
    sigaction(signal, &action, nullptr);
  }
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

void catch_suspend_of_screen() {
  struct sigaction action {};
  action.sa_flags = SA_RESTART;
  action.sa_handler = &note_continuation;
  sigaction(SIGCONT, &action, nullptr);
  struct sigaction before {};
  sigaction(SIGTSTP, nullptr, &before);
  if (before.sa_handler != SIG_DFL) return;
  action.sa_handler = &suspend_now;
  sigaction(SIGTSTP, &action, nullptr);
}

std::atomic<bool>& continued() noexcept {
  return has_continued;
}

int interrupted_code() noexcept {
  const int signal = stop_signal.load(std::memory_order_relaxed);
  return signal != 0 ? 128 + signal : 0;
}

std::atomic<bool>& rearm_asked() noexcept {
  return rearming_asked;
}

void catch_rearm() {
  struct sigaction action {};
  action.sa_handler = &note_rearm;
  action.sa_flags = SA_RESTART;
  sigaction(SIGUSR1, &action, nullptr);
}

void request_stop() noexcept {
  stop_asked.store(true, std::memory_order_relaxed);
}

}  // namespace tandem::app
