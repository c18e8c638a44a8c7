#include "app/process/watchdog.hpp"

#include <algorithm>
#include <chrono>
#include <csignal>
#include <fmt/format.h>
#include <system_error>
#include <vector>

#include "app/process/emergency.hpp"
#include "app/process/measure.hpp"
#include "app/process/terminal.hpp"
#include "hal/plugin_call.hpp"

namespace tandem::app {
namespace {

constexpr double kPatience_s = 5.0;  // after a stop, when nobody is named

/// What a mark showed, and since when.
struct Seen {
  std::size_t calls = 0;
  std::size_t index = 0;
  bool running = false;
  double since_s = 0.0;
  std::string told;  ///< whom was told of; empty: nobody

  static Seen of(const hal::CallMark& mark, double now_s) {
    return {mark.calls.load(std::memory_order_relaxed),
            mark.index(),
            mark.name.load(std::memory_order_acquire) != nullptr,
            now_s,
            {}};
  }
  bool same(const Seen& other) const {
    return calls == other.calls && index == other.index && running == other.running;
  }
};

std::string name_of(const hal::CallMark& mark) {
  hal::FixedText text;
  return hal::name_call(mark, text) ? std::string(text.view()) : std::string();
}

}  // namespace

Watchdog::Watchdog(double limit_s, const std::atomic<bool>& stop, double end_s)
    : limit_s_(limit_s), end_s_(end_s), stop_(stop) {
  // Signals are for the threads that sleep in loops that look at `stop`.
  sigset_t all, before;
  sigfillset(&all);
  pthread_sigmask(SIG_SETMASK, &all, &before);
  try {
    thread_ = std::thread([this] { watch(); });
  } catch (const std::system_error& e) {
    say(fmt::format("warning: nobody watches for controllers that do not return: no thread can be made ({})",
                    e.code().message()));
  }
  pthread_sigmask(SIG_SETMASK, &before, nullptr);
}

Watchdog::~Watchdog() {
  {
    const std::lock_guard hold(ending_lock_);
    ending_ = true;
  }
  ending_changed_.notify_all();
  if (thread_.joinable()) thread_.join();
}

void Watchdog::set_save(std::function<void()> save) {
  const std::lock_guard hold(lock_);
  save_ = std::move(save);
}

void Watchdog::watch() {
  const double patience_s = limit_s_ > 0.0 ? limit_s_ : kPatience_s;
  const double shortest_s = end_s_ > 0.0 ? std::min(patience_s, end_s_) : patience_s;
  const std::chrono::duration<double> pause(std::clamp(shortest_s / 20.0, 0.002, 0.1));
  auto& marks = hal::call_marks();
  std::vector<Seen> seen(marks.size());
  double last_s = wall_seconds();
  std::unique_lock ending(ending_lock_);
  while (!ending_changed_.wait_for(ending, pause, [this] { return ending_; })) {
    const double now_s = wall_seconds();
    const bool slept = now_s - last_s > 1.0;  // this program was suspended, or the machine is at its limit
    last_s = now_s;
    for (std::size_t i = 0; i < marks.size(); ++i) {
      Seen now = Seen::of(marks[i], now_s);
      if (!now.same(seen[i]) || !now.running || slept) {
        if (!seen[i].told.empty() && !slept)
          say(fmt::format("{} has returned after {:.1f} s", seen[i].told, now_s - seen[i].since_s));
        if (slept) now.told = seen[i].told;
        seen[i] = std::move(now);
        continue;
      }
      const double took_s = now_s - seen[i].since_s;
      const bool over = end_s_ > 0.0 && took_s >= end_s_;
      if (took_s < patience_s && !over) continue;
      if (limit_s_ > 0.0 && seen[i].told.empty()) {
        seen[i].told = name_of(marks[i]);
        say(fmt::format("{} has not returned for {:.1f} s; Ctrl-C ends the run, and keeps all whole ticks",
                        seen[i].told, took_s));
      }
      const bool stopped = stop_.load(std::memory_order_relaxed);
      if (!stopped && !over) continue;
      const std::lock_guard hold(lock_);
      if (!Seen::of(marks[i], now_s).same(seen[i])) continue;
      const std::string who = name_of(marks[i]);
      if (save_) save_();
      end_now(fmt::format("{} did not return within {:.1f} s, {}", who, took_s,
                          stopped ? "and the run was interrupted" : "the --step-limit"));
    }
  }
}

}  // namespace tandem::app
