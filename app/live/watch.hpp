// `--watch`: a live table and map of a run, or of a record, on a terminal, or lines where there is none.
#pragma once
#include <functional>
#include <memory>
#include <string>
#include <vector>

#include "app/live/watch_page.hpp"
#include "app/run_options.hpp"
#include "core/live/live_run.hpp"
#include "hal/result.hpp"

namespace tandem::app {

/// Has a thread of its own, which draws and reads keys; the thread that steps is asked ten times a second, or less
/// often, by a command of the live run.
class Watch {
 public:
  struct Run {
    core::Watched& watched;
    std::function<WatchSight()> sight;  ///< as it is now; called where `watched` carries out commands
    std::string experiment;
    std::int64_t ticks = 0;  ///< 0: no end of its own
    std::int64_t ticks_per_second = 10;
    std::function<void(WatchMoment&)> add_real = {};  ///< lines about real robots; empty: none take part
    std::function<void()> end = {};                   ///< ends the run in order; on any thread
  };
  /// Errors: no robot fits; none of those that do has the port.
  static hal::Status check(const WatchRequest& request, const core::Space& space);

  /// Before the run's first step; from now on `say` speaks to this. All of `run` must outlive it.
  Watch(const WatchRequest& request, const Run& run);
  /// Leaves the terminal as it was, with what was said meanwhile.
  ~Watch();
  Watch(const Watch&) = delete;
  Watch& operator=(const Watch&) = delete;

 private:
  struct Impl;
  std::unique_ptr<Impl> impl_;
};

}  // namespace tandem::app
