// Makes worlds and runs them, one after the other.
#pragma once
#include <atomic>
#include <functional>
#include <memory>
#include <string>
#include <utility>

#include "core/run/run.hpp"
#include "core/sim/world.hpp"
#include "hal/plugin_loader.hpp"
#include "study/design.hpp"
#include "study/run_row.hpp"
#include "study/sweep/hang_limit.hpp"
#include "study/sweep/sampling.hpp"

namespace tandem::study {

/// The experiment of a run. Error: for people.
using ScenarioOf = std::function<hal::Result<core::Scenario>(const RunPlan& plan)>;

/// Where a run's state is kept while it is made.
std::string checkpoint_of(const std::string& folder, std::int64_t run);

/// Runs one run after the other in one thread. A world is used again for the next run of the same configuration, which
/// is then as in a world of its own (World::reset).
class Runner {
 public:
  /// All must outlive this. `keeps_worlds` false: every run has a world of its own. A step that takes longer than
  /// `step_limit_s` of real time ends the process; 0: none does. In the folder `checkpoints` runs that take
  /// longer are kept every `keep_every_s` of real time, and go on from there; empty: none are.
  Runner(const ScenarioOf& scenario_of, hal::PluginLoader& loader, const Measuring& measuring, bool keeps_worlds,
         double step_limit_s, std::string checkpoints = {}, double keep_every_s = 60.0)
      : scenario_of_(scenario_of),
        loader_(loader),
        measuring_(measuring),
        keeps_worlds_(keeps_worlds),
        checkpoints_(std::move(checkpoints)),
        keep_every_s_(keep_every_s),
        hang_(step_limit_s) {}

  RunOutcome run(const RunPlan& plan);

 private:
  class Measured;
  hal::Status ready(const RunPlan& plan);
  hal::Status make(const RunPlan& plan);
  hal::Status go_on(const RunPlan& plan, Sampler& sampler);
  void keep(const RunPlan& plan, Sampler& sampler);

  const ScenarioOf& scenario_of_;
  hal::PluginLoader& loader_;
  const Measuring& measuring_;
  bool keeps_worlds_;
  std::string checkpoints_;
  double keep_every_s_;
  HangLimit hang_;
  const std::atomic<bool> never_{false};
  std::unique_ptr<core::World> world_;
  std::int64_t configuration_ = -1;  // of the world
  double kept_s_ = 0.0;              // when the run was kept last, or began
  bool takes_long_ = false;          // the last run did: worlds that are made again can be kept
};

}  // namespace tandem::study
