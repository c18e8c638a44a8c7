// Makes all runs of a study on all cores, and hands over their results.
#pragma once
#include <atomic>
#include <cstdint>
#include <functional>
#include <span>
#include <string>
#include <vector>

#include "hal/result.hpp"
#include "study/sweep/run_once.hpp"

namespace tandem::study {

/// A run that is over.
struct FinishedRun {
  RunPlan plan;
  RunOutcome outcome;
};

struct SweepOptions {
  std::size_t workers = 1;     ///< processes, each with one run at a time
  bool isolate = false;        ///< every run in a process of its own
  bool keeps_worlds = true;    ///< false: every run in a world of its own
  double time_limit_s = 0.0;   ///< real time after which a run has failed; 0: none
  double step_limit_s = 0.0;   ///< the same of one step
  std::string checkpoints;     ///< folder for runs that take long; empty: none is kept
  double keep_every_s = 60.0;  ///< of real time
  Measuring measuring;
  std::function<void()> in_worker;  ///< called first in every process
};

/// Makes `runs` of `design` in forked processes: a run that takes its process with it has failed, and the others go on;
/// one that was kept in `checkpoints` meanwhile goes on from there.
/// `scenario_of` is called in the workers, which are copies of this process, with `loader`. `take` gets each run once,
/// in no order, on this thread; its error ends the sweep. `tick` is called some ten times a second. Ends early when
/// `stop` is set: what is in flight is then lost. This process must have no other threads.
hal::Status sweep(const Design& design, const std::vector<std::int64_t>& runs, const ScenarioOf& scenario_of,
                  hal::PluginLoader& loader, const SweepOptions& options,
                  const std::function<hal::Status(std::span<const FinishedRun>)>& take,
                  const std::function<void()>& tick, const std::atomic<bool>& stop);

}  // namespace tandem::study
