#include <array>

#include "app/command/command.hpp"
#include "app/command/shared_options.hpp"
#include "app/process/signals.hpp"
#include "app/process/terminal.hpp"
#include "app/run/parts.hpp"

namespace tandem::app {
namespace {

constexpr std::array<AddPart, 8> kParts = {&add_real_robots, &add_resumption, &add_hold,  &add_outputs,
                                           &add_checkpoints, &add_desk,       &add_views, &add_named_parts};

/// All but the end of the log, which outlives the world.
int run_with(const RunOptions& options, RunLog& log) {
  RunPlan plan(options, log);
  if (const int code = prepare_run(plan); code != kDone) return code;
  core::Run run(*plan.world, *plan.stop);
  for (const AddPart add : kParts) {
    if (const int code = add(plan, run); code != kDone) return code;
  }
  if (!run.go()) return complain(kFailedRunning, run.failure());
  const Ended how = plan.result->end.how;
  if (how == Ended::Failed || !plan.written || !run.failure().empty()) return plan.code_of_failure;
  const bool until_interrupted = options.view.on && options.hold.stay;  // that is how such a run ends
  return how == Ended::Interrupted && !until_interrupted ? interrupted_code() : kDone;
}

}  // namespace

int run(const RunOptions& options) {
  RunLog log;
  int code = run_with(options, log);
  if (!log.over()) return code;
  if (const hal::Status logged = log.close(); !logged.ok()) code = complain(kFailedRunning, logged.error().message);
  if (code == kDone && log.late_errors() > 0)
    code = complain(kFailedRunning, "a controller or hook failed at its end, as told above; the results stand");
  return code;
}

namespace {

struct RunLine : PagedRunOptions {
  void describe(hal::CommandLine& line) {
    line.word("experiment", experiment, "The experiment file (.xml)").file();
    line.option("--resume", resume, "Go on from a checkpoint (--checkpoint), which has the experiment").file();
    describe_page(line, "Serve a page that shows the run, on port --view=PORT or any that is free");
    describe_run(line, *this);
  }
};

int run_line(const RunLine& line) {
  if (line.experiment.empty() == line.resume.empty())
    return complain(kWrongUsage,
                    "name the experiment file, or a checkpoint with --resume, which has the experiment; 'tandem run "
                    "--help' tells what there is");
  return run(line.with_page());
}

}  // namespace

constinit const hal::CommandType run_command =
    hal::command_type<RunLine, run_line>("run", "Run an experiment.", hal::command_group::kSimulate);

}  // namespace tandem::app
