// Threads for the parallel phases of a step: work is split in advance or handed out, without locks and without
// allocation.
#pragma once
#include <atomic>
#include <chrono>
#include <cstddef>
#include <cstdint>
#include <thread>
#include <vector>

#include "core/scenario/scenario.hpp"

namespace tandem::core {

/// A team of `threads` workers, the caller being one of them. With 0 or 1 everything runs on the caller.
/// Results of a phase must not depend on how it is cut: then they are the same for any number of threads.
class ThreadPool {
 public:
  /// @throws std::system_error when the system does not give so many; none of them is left then
  ThreadPool(std::size_t threads, Assignment assignment);
  ~ThreadPool();
  ThreadPool(const ThreadPool&) = delete;
  ThreadPool& operator=(const ThreadPool&) = delete;

  std::size_t size() const noexcept { return workers_.size() + 1; }

  /// Calls `work(begin, end)` for parts that together are [0, count), each once, and returns when all are done. Fewer
  /// than `2 * grain` items run on the caller alone; `grain` is also the size of a part under dynamic assignment.
  template <class Work>
  void run(std::size_t count, std::size_t grain, Work&& work) {
    if (workers_.empty() || count < 2 * grain) {
      if (count > 0) work(std::size_t{0}, count);
      return;
    }
    const Phase phase{[](void* w, std::size_t begin, std::size_t end) {
                        (*static_cast<std::remove_reference_t<Work>*>(w))(begin, end);
                      },
                      const_cast<void*>(static_cast<const void*>(&work)), count, grain};
    dispatch(phase);
  }

  /// Calls `work(part)` for part 0 … size() - 1, each on a thread of its own. For phases that cut their data
  /// themselves.
  template <class Work>
  void run_parts(Work&& work) {
    run_parts(size(), work);
  }
  template <class Work>
  void run_parts(std::size_t parts, Work&& work) {
    run(parts, 1, [&](std::size_t begin, std::size_t end) {
      for (std::size_t part = begin; part < end; ++part) work(part);
    });
  }

 private:
  struct Phase {
    void (*call)(void*, std::size_t, std::size_t) = nullptr;
    void* work = nullptr;
    std::size_t count = 0;
    std::size_t grain = 1;
  };
  void dispatch(const Phase& phase);
  void take_part(std::size_t worker);
  void work_loop(std::size_t worker);
  void end() noexcept;

  Assignment assignment_;
  int spins_ = 0;  // looks at the next phase before sleeping
  Phase phase_;
  alignas(64) std::atomic<std::uint32_t> round_{0};  // raised once a phase; workers wait for it
  alignas(64) std::atomic<std::uint32_t> unfinished_{0};
  alignas(64) std::atomic<std::size_t> next_{0};  // dynamic assignment: first item not handed out
  std::atomic<bool> ending_{false};
  std::vector<std::thread> workers_;
};

/// A phase that is run again and again, and measured: while it takes less than what waking other processors and
/// bringing them its data is worth, it runs on the caller.
class MeasuredPhase {
 public:
  /// As ThreadPool::run with a grain of 1.
  template <class Work>
  void run(ThreadPool& pool, std::size_t count, Work&& work) {
    if (pool.size() == 1 || count < 2) return pool.run(count, 1, work);
    const bool alone = item_s_ * static_cast<double>(count) < kWorthThreads_s;
    pool.run(count, alone ? count : 1, [&](std::size_t begin, std::size_t end) {
      if (begin != 0) return work(begin, end);
      const auto began = std::chrono::steady_clock::now();
      work(begin, end);
      const std::chrono::duration<double> took = std::chrono::steady_clock::now() - began;
      item_s_ = took.count() / static_cast<double>(end);
    });
  }

 private:
  // 1,000 small robots (50 us of sensing and control) are stepped slower by two processors than by one, 2,000 faster.
  static constexpr double kWorthThreads_s = 80e-6;
  double item_s_ = 1.0;  // not measured yet: shared out
};

}  // namespace tandem::core
