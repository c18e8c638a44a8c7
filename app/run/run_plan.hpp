// What the parts of one run share: made before them, and destroyed after them.
#pragma once
#include <atomic>
#include <functional>
#include <memory>
#include <optional>

#include "app/experiment/plugins.hpp"
#include "app/outputs/run_log.hpp"
#include "app/outputs/run_outputs.hpp"
#include "app/outputs/run_report.hpp"
#include "app/process/measure.hpp"
#include "app/process/watchdog.hpp"
#include "app/replay/replay_run.hpp"
#include "app/robots/command_log.hpp"
#include "app/robots/desks.hpp"
#include "app/robots/guarded_robots.hpp"
#include "app/robots/hub_faults.hpp"
#include "app/run_options.hpp"
#include "core/live/live_run.hpp"
#include "core/live/repeat.hpp"
#include "core/record/checkpoint_file.hpp"
#include "core/run/run.hpp"
#include "core/sim/world.hpp"
#include "core/view/drawing.hpp"
#include "mixed_reality/session/mixed_session.hpp"

namespace tandem::app {

/// Filled from top to bottom. The pointers to parts are null where there is no such part.
struct RunPlan {
  RunPlan(const RunOptions& asked, RunLog& to) : options(asked), log(to) {}

  const RunOptions& options;
  RunLog& log;
  const double began_s = wall_seconds();
  HubFaults hub_faults;
  hal::PluginLoader loader = make_loader();
  ExperimentReading reading{loader, options.plugins};
  ReplayRun replay{options};
  std::optional<GuardedRobots> guarded;
  std::optional<core::Scenario> scenario;
  const std::atomic<bool>* stop = nullptr;
  std::optional<Watchdog> watchdog;
  core::Repeatable repeated;
  std::optional<core::Checkpoint> resumed;
  hal::Log world_log;
  std::unique_ptr<core::World> made;  ///< until real robots take it over
  core::World* world = nullptr;
  InputFiles inputs;
  std::int64_t steps = 0;
  RunOutputs outputs;
  mixed_reality::MonotonicTime clock;

  mixed_reality::MixedSession* mixed = nullptr;
  mixed_reality::LockstepRun* lockstep = nullptr;
  core::LiveRun* live = nullptr;
  std::optional<CommandLog> commands;
  Desks* desks = nullptr;
  std::function<core::Drawing()> drawing;  ///< the picture as it would be written now
  std::function<void()> look;              ///< while real robots stand, because somebody paused the run

  std::optional<RunResult> result;  ///< filled by the parts that finish
  bool as_before = true;            ///< as in the run that is repeated
  bool guarded_to_the_end = true;
  std::vector<std::string> left;  ///< robots whose stop nobody has confirmed
  bool written = true;            ///< all that was asked for
  int code_of_failure = kFailedRunning;
};

/// Reads the experiment, starts the guardian, makes the world, opens the outputs. @returns kDone, or what was wrong,
/// which was told.
int prepare_run(RunPlan& plan);

}  // namespace tandem::app
