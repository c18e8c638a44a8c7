// Makes worlds and runs them, one after the other.
#pragma once
#include <functional>
#include <memory>

#include "core/sim/world.hpp"
#include "hal/plugin_loader.hpp"
#include "study/design.hpp"
#include "study/run_row.hpp"
#include "study/sweep/hang_limit.hpp"
#include "study/sweep/sampling.hpp"

namespace tandem::study {

/// The experiment of a run. Error: for people.
using ScenarioOf = std::function<hal::Result<core::Scenario>(const RunPlan& plan)>;

/// Runs one run after the other in one thread. A world is used again for the next run of the same configuration, which
/// is then as in a world of its own (World::reset).
class Runner {
 public:
  /// All must outlive this. `keeps_worlds` false: every run has a world of its own. A step that takes longer than
  /// `step_limit_s` of real time ends the process; 0: none does.
  Runner(const ScenarioOf& scenario_of, hal::PluginLoader& loader, const Measuring& measuring, bool keeps_worlds,
         double step_limit_s)
      : scenario_of_(scenario_of),
        loader_(loader),
        measuring_(measuring),
        keeps_worlds_(keeps_worlds),
        hang_(step_limit_s) {}

  RunOutcome run(const RunPlan& plan);

 private:
  hal::Status ready(const RunPlan& plan);

  const ScenarioOf& scenario_of_;
  hal::PluginLoader& loader_;
  const Measuring& measuring_;
  bool keeps_worlds_;
  HangLimit hang_;
  std::unique_ptr<core::World> world_;
  std::int64_t configuration_ = -1;  // of the world
};

}  // namespace tandem::study
