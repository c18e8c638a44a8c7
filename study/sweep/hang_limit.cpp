#include "study/sweep/hang_limit.hpp"

#include <atomic>
#include <cmath>
#include <csignal>
#include <cstdint>
#include <sys/time.h>
#include <unistd.h>

#include "hal/plugin_call.hpp"

namespace tandem::study {
namespace {

std::atomic<std::uint32_t> steps{0};
std::uint32_t steps_seen = 0;  // the handler's
int looks_without = 0, most_looks = 0;

void look(int) noexcept {
  const std::uint32_t now = steps.load(std::memory_order_relaxed);
  looks_without = now == steps_seen ? looks_without + 1 : 0;
  steps_seen = now;
  if (looks_without < most_looks) return;
  hal::FixedText text;
  const hal::CallMark* const mark = hal::known_thread_mark();
  if (mark == nullptr || !hal::name_call(*mark, text)) text << "a step";
  text << " has not returned for " << std::int64_t{most_looks} << " s, the study's step_limit\n";
  (void)!write(STDERR_FILENO, text.view().data(), text.view().size());
  _exit(1);
}

void set_timer(long seconds) noexcept {
  itimerval every{};
  every.it_interval.tv_sec = every.it_value.tv_sec = seconds;
  setitimer(ITIMER_REAL, &every, nullptr);
}

}  // namespace

HangLimit::Watched::Watched(const HangLimit& limit) noexcept {
  if (!(limit.limit_s_ > 0.0)) return;
  looks_without = 0;
  most_looks = static_cast<int>(std::ceil(limit.limit_s_));
  struct sigaction action {};
  action.sa_handler = &look;
  action.sa_flags = SA_RESTART | SA_ONSTACK;
  sigaction(SIGALRM, &action, nullptr);
  set_timer(1);
}

HangLimit::Watched::~Watched() {
  set_timer(0);
}

void HangLimit::step() noexcept {
  steps.store(steps.load(std::memory_order_relaxed) + 1, std::memory_order_relaxed);
}

}  // namespace tandem::study
