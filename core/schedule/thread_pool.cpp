// A pool of our own instead of oneTBB, which keeps its own arenas, allocates tasks, and reports false races under the
// thread sanitizer: a step has four phases of 0.05 to 50 ms, some hundred times a second, and must not allocate. ARGoS'
// users expect a static and a dynamic assignment of work.
#include "core/schedule/thread_pool.hpp"

#include <algorithm>

namespace tandem::core {
namespace {

/// How often a worker looks for the next phase before it sleeps: phases of one step follow one another within
/// microseconds, steps of a paced run do not.
constexpr int kSpins = 4000;
constexpr int kSpinsToYield = 64;

void pause_cpu() noexcept {
#if defined(__x86_64__) || defined(__i386__)
  __builtin_ia32_pause();
#endif
}

/// Waits until `value` is no longer `old`. Every few microseconds it gives way to whoever else wants this processor: on
/// a machine with other work that may be the very thread that is waited for.
void await_change(std::atomic<std::uint32_t>& value, std::uint32_t old, int spins) noexcept {
  for (int i = 1; i <= spins; ++i) {
    if (value.load(std::memory_order_acquire) != old) return;
    pause_cpu();
    if (i % kSpinsToYield == 0) std::this_thread::yield();
  }
  value.wait(old, std::memory_order_acquire);
}

}  // namespace

ThreadPool::ThreadPool(std::size_t threads, Assignment assignment) : assignment_(assignment) {
  // Spinning only helps where every worker has a processor of its own.
  spins_ = threads <= std::thread::hardware_concurrency() ? kSpins : 0;
  try {
    for (std::size_t i = 1; i < threads; ++i) workers_.emplace_back([this, i] { work_loop(i); });
  } catch (...) {
    end();
    throw;
  }
}

ThreadPool::~ThreadPool() {
  end();
}

void ThreadPool::end() noexcept {
  ending_.store(true, std::memory_order_relaxed);
  round_.fetch_add(1, std::memory_order_release);
  round_.notify_all();
  for (std::thread& worker : workers_) worker.join();
}

void ThreadPool::dispatch(const Phase& phase) {
  phase_ = phase;
  next_.store(0, std::memory_order_relaxed);
  unfinished_.store(static_cast<std::uint32_t>(workers_.size()), std::memory_order_relaxed);
  round_.fetch_add(1, std::memory_order_release);
  round_.notify_all();
  take_part(0);
  for (std::uint32_t left = unfinished_.load(std::memory_order_acquire); left != 0;
       left = unfinished_.load(std::memory_order_acquire)) {
    await_change(unfinished_, left, spins_);
  }
}

void ThreadPool::take_part(std::size_t worker) {
  const Phase& p = phase_;
  if (assignment_ == Assignment::Static) {
    const std::size_t begin = p.count * worker / size();
    const std::size_t end = p.count * (worker + 1) / size();
    if (begin < end) p.call(p.work, begin, end);
    return;
  }
  for (;;) {
    const std::size_t begin = next_.fetch_add(p.grain, std::memory_order_relaxed);
    if (begin >= p.count) return;
    p.call(p.work, begin, std::min(begin + p.grain, p.count));
  }
}

void ThreadPool::work_loop(std::size_t worker) {
  std::uint32_t seen = 0;
  for (;;) {
    await_change(round_, seen, spins_);
    seen = round_.load(std::memory_order_acquire);
    if (ending_.load(std::memory_order_relaxed)) return;
    take_part(worker);
    if (unfinished_.fetch_sub(1, std::memory_order_acq_rel) == 1) unfinished_.notify_one();
  }
}

}  // namespace tandem::core
