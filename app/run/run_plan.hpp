// Shared data of the parts of one run: made before them, and destroyed after them.
#pragma once
#include <atomic>
#include <functional>
#include <memory>
#include <optional>
#include <string>
#include <vector>

#include "app/experiment/plugins.hpp"
#include "app/outputs/run_log.hpp"
#include "app/outputs/run_outputs.hpp"
#include "app/outputs/run_report.hpp"
#include "app/process/measure.hpp"
#include "app/process/watchdog.hpp"
#include "app/run/real_side.hpp"
#include "app/run/run_module.hpp"
#include "app/run_options.hpp"
#include "core/record/checkpoint_file.hpp"
#include "core/run/run.hpp"
#include "core/sim/world.hpp"
#include "mixed_reality/time/monotonic.hpp"
#include "mixed_reality/time/pacer.hpp"

namespace tandem::core {
struct Drawing;
class LiveRun;
struct Repeatable;
}  // namespace tandem::core

namespace tandem::app {

class CommandLog;

/// Filled from top to bottom. The pointers to parts are null where there is no such part.
struct RunPlan {
  RunPlan(const RunOptions& asked, RunLog& to) : options(asked), log(to) {}

  const RunOptions& options;
  RunLog& log;
  const double began_s = wall_seconds();
  hal::PluginLoader loader = make_loader();
  ExperimentReading reading{loader, options.plugins};
  std::vector<const RunModule*> modules;  ///< that this run needs, in the order of their parts
  std::unique_ptr<RealSide> side;         ///< null: all is simulated, and this is no replay
  std::optional<core::Scenario> scenario;
  const std::atomic<bool>* stop = nullptr;
  std::optional<Watchdog> watchdog;
  std::shared_ptr<core::Repeatable> repeated;  ///< what is done again; null: nothing
  std::optional<std::uint64_t> seed;           ///< of the run that is done again
  std::optional<core::Checkpoint> resumed;     ///< that it goes on from
  hal::Log world_log;
  std::unique_ptr<core::World> made;  ///< until real robots take it over
  core::World* world = nullptr;
  InputFiles inputs;
  std::int64_t steps = 0;
  RunOutputs outputs;
  mixed_reality::MonotonicTime clock;
  std::optional<mixed_reality::Pacer> pacer;  ///< of a run in real time without another pace

  std::vector<std::unique_ptr<core::RunPart>> opened;  ///< parts with open files, until they are added
  RealRobots* real = nullptr;
  bool peers = false;  ///< take part, in lock-step: no way back
  core::LiveRun* live = nullptr;
  std::shared_ptr<const CommandLog> commands;
  std::function<core::Drawing()> drawing;  ///< the picture as it would be written now; empty: no drawing
  std::function<void()> look;              ///< while real robots stand, because the run is paused

  std::optional<RunResult> result;  ///< filled by the parts that finish
  std::string live_failure;         ///< what could not be done again
  bool as_before = true;            ///< as in the run that is repeated
  bool written = true;              ///< all that was asked for
  int code_of_failure = kFailedRunning;

  bool replays() const noexcept { return !options.replay.record.empty(); }
};

/// Whether people may hold this run, watch it, or have it repeated.
bool is_held(const RunOptions& options) noexcept;

/// The module of that name that this run has; null: none.
const RunModule* module_of(const RunPlan& plan, std::string_view name) noexcept;
/// Has the run have it; built and loaded where that is needed. @returns the program's code; errors were reported.
int need_for_run(RunPlan& plan, std::string_view name);

/// Reads the experiment, starts the guardian, makes the world, opens the outputs. @returns kDone, or what was wrong,
/// which was reported.
int prepare_run(RunPlan& plan);

}  // namespace tandem::app
