// A process that makes runs.
#pragma once
#include <deque>
#include <functional>
#include <memory>
#include <optional>
#include <string>
#include <sys/types.h>
#include <vector>

#include "hal/result.hpp"
#include "study/sweep/message.hpp"

namespace tandem::study {

/// The parent's end of a forked worker. What the worker prints is kept for messages. It ends with its parent, and by
/// SIGKILL when this ends.
class Worker {
 public:
  /// In the worker: makes the run of this number.
  using Make = std::function<RunOutcome(std::int64_t run)>;

  /// Forks. `in_child` is called first there. `one_run`: it ends after one run. Error: no process, no pipe.
  static hal::Result<std::unique_ptr<Worker>> start(const Make& make, const std::function<void()>& in_child,
                                                    bool one_run);
  ~Worker();
  Worker(const Worker&) = delete;
  Worker& operator=(const Worker&) = delete;

  /// Hands over a run; `now_s` is a time of a steady clock. False: it is gone.
  bool give(std::int64_t run, double now_s);
  /// Runs that it was given and has not told of, in their order.
  const std::deque<std::int64_t>& given() const noexcept { return given_; }
  /// One ahead of short runs, so that it never waits; of long ones no other worker shall wait for it at the end.
  bool may_be_given_more() const noexcept { return one_run_ ? !used_ : given_.size() < (short_runs_ ? 2 : 1); }
  /// Since when it makes the first of them.
  double since_s() const noexcept { return since_s_; }

  int results() const noexcept { return results_; }  ///< to poll
  int words() const noexcept { return words_; }      ///< to poll; -1: closed

  /// Appends what it told. False: it is gone.
  bool receive(std::vector<ToldOutcome>& told, double now_s);
  /// Reads what it printed.
  void listen();
  /// Waits for its end, which has come or is brought. @returns how it ended and what it said last, for people
  std::string end();

 private:
  Worker() = default;

  pid_t pid_ = -1;
  int results_ = -1, words_ = -1;
  bool one_run_ = false, used_ = false, short_runs_ = false;
  double since_s_ = 0.0;
  std::deque<std::int64_t> given_;
  std::string received_, said_;
};

}  // namespace tandem::study
