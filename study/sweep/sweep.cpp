#include "study/sweep/sweep.hpp"

#include <algorithm>
#include <cerrno>
#include <ctime>
#include <filesystem>
#include <map>
#include <poll.h>

#include "hal/unit.hpp"
#include "study/sweep/queue.hpp"
#include "study/sweep/worker.hpp"

namespace tandem::study {
namespace {

constexpr int kLook_ms = 100;

double now_s() noexcept {
  timespec t{};
  clock_gettime(CLOCK_MONOTONIC, &t);
  return static_cast<double>(t.tv_sec) + 1e-9 * static_cast<double>(t.tv_nsec);
}

/// All workers, and the runs between them and the queue.
class Pool {
 public:
  Pool(const Design& design, const std::vector<std::int64_t>& runs, const SweepOptions& options,
       const Worker::Make& make)
      : design_(design),
        options_(options),
        make_(make),
        workers_(std::clamp<std::size_t>(options.workers, 1, std::max<std::size_t>(1, runs.size()))),
        queue_(runs, design.configurations(), workers_.size()),
        left_(runs.size()) {}

  bool done() const noexcept { return left_ == 0; }

  /// Keeps every worker busy. Error: there is none, and none can be made.
  hal::Status feed() {
    hal::Status why;
    for (std::size_t i = 0; i < workers_.size(); ++i) {
      for (;;) {
        if (workers_[i] != nullptr && !workers_[i]->may_be_given_more()) break;
        const auto run = queue_.next(i);
        if (!run) break;
        if (workers_[i] == nullptr) {
          auto started = Worker::start(make_, options_.in_worker, options_.isolate);
          if (!started.ok()) {
            queue_.put_back(i, *run);
            why = started.error();
            break;
          }
          workers_[i] = std::move(started).value();
        }
        if (workers_[i]->give(*run, now_s())) continue;
        queue_.put_back(i, *run);  // it is gone: `look` will find out
        break;
      }
    }
    const bool any = std::any_of(workers_.begin(), workers_.end(), [](const auto& w) { return w != nullptr; });
    return any ? hal::Status{} : why;
  }

  /// Waits until a worker tells something, or for a moment.
  std::vector<FinishedRun> look() {
    std::vector<pollfd> wanted;
    for (const auto& worker : workers_) {
      if (worker == nullptr) continue;
      wanted.push_back({worker->results(), POLLIN, 0});
      wanted.push_back({worker->words(), POLLIN, 0});  // -1 is passed over
    }
    (void)poll(wanted.data(), wanted.size(), kLook_ms);
    std::vector<FinishedRun> finished;
    std::size_t at = 0;
    for (std::size_t i = 0; i < workers_.size(); ++i) {
      if (workers_[i] == nullptr) continue;
      const bool told = wanted[at].revents != 0, said = wanted[at + 1].revents != 0;
      at += 2;
      if (said) workers_[i]->listen();
      if (told) hear(i, finished);
      if (workers_[i] != nullptr) watch(i, finished);
    }
    left_ -= finished.size();
    return finished;
  }

 private:
  void hear(std::size_t i, std::vector<FinishedRun>& finished) {
    std::vector<ToldOutcome> told;
    const bool there = workers_[i]->receive(told, now_s());
    for (ToldOutcome& t : told) finished.push_back({design_.run(t.run), std::move(t.outcome)});
    if (!there) bury(i, workers_[i]->end(), finished);
  }

  /// Ends a worker whose run takes too long.
  void watch(std::size_t i, std::vector<FinishedRun>& finished) {
    const Worker& worker = *workers_[i];
    if (!(options_.time_limit_s > 0.0) || worker.given().empty()) return;
    if (now_s() - worker.since_s() < options_.time_limit_s) return;
    bury(i, "took longer than the study's time limit of " + hal::format_number(options_.time_limit_s) + " s", finished,
         false);
  }

  /// The run that the worker was making has failed, or goes on elsewhere; the others that it was given are for somebody
  /// else.
  void bury(std::size_t i, const std::string& why, std::vector<FinishedRun>& finished, bool may_go_on = true) {
    const std::deque<std::int64_t> given = workers_[i]->given();
    workers_[i].reset();
    for (std::size_t n = given.size(); n-- > 1;) queue_.put_back(i, given[n]);
    if (given.empty()) return;
    if (may_go_on && has_got_on(given.front())) return queue_.put_back(i, given.front());
    FinishedRun& failed = finished.emplace_back();
    failed.plan = design_.run(given.front());
    failed.outcome.ended = "failed";
    failed.outcome.failure = why;
  }

  /// Whether the run was kept since the last time that its process was lost: who makes it again gets farther.
  bool has_got_on(std::int64_t run) {
    std::error_code none;
    const auto kept = std::filesystem::last_write_time(checkpoint_of(options_.checkpoints, run), none);
    return !options_.checkpoints.empty() && !none && std::exchange(kept_[run], kept) != kept;
  }

  const Design& design_;
  const SweepOptions& options_;
  const Worker::Make& make_;
  std::map<std::int64_t, std::filesystem::file_time_type> kept_;  // of runs whose processes were lost
  std::vector<std::unique_ptr<Worker>> workers_;
  RunQueue queue_;
  std::size_t left_;
};

}  // namespace

hal::Status sweep(const Design& design, const std::vector<std::int64_t>& runs, const ScenarioOf& scenario_of,
                  hal::PluginLoader& loader, const SweepOptions& options,
                  const std::function<hal::Status(std::span<const FinishedRun>)>& take,
                  const std::function<void()>& tick, const std::atomic<bool>& stop) {
  Runner runner(scenario_of, loader, options.measuring, options.keeps_worlds && !options.isolate, options.step_limit_s,
                options.checkpoints, options.keep_every_s);
  const Worker::Make make = [&](std::int64_t run) { return runner.run(design.run(run)); };
  Pool pool(design, runs, options, make);
  double told_s = now_s();
  while (!pool.done() && !stop.load(std::memory_order_relaxed)) {
    if (const hal::Status fed = pool.feed(); !fed.ok()) return fed;
    const std::vector<FinishedRun> finished = pool.look();
    if (!finished.empty()) {
      if (const hal::Status taken = take(finished); !taken.ok()) return taken;
    }
    if (now_s() - told_s < 1e-3 * kLook_ms) continue;
    told_s = now_s();
    tick();
  }
  return {};
}

}  // namespace tandem::study
