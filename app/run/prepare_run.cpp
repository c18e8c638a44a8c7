#include <csignal>
#include <iterator>

#include "app/build_info.hpp"
#include "app/experiment/reading.hpp"
#include "app/process/signals.hpp"
#include "app/process/terminal.hpp"
#include "app/robots/mixed_run.hpp"
#include "app/run/run_plan.hpp"
#include "app/view/watch.hpp"
#include "core/live/source_files.hpp"
#include "hal/json/json_access.hpp"

namespace tandem::app {
namespace {

/// The status's error, told; kDone where there is none.
int told(const hal::Status& status, int code = kBadInput) {
  return status.ok() ? kDone : complain(code, status.error().message);
}

/// The experiment of the checkpoint that the run is to go on from.
int open_resumed(RunPlan& plan) {
  const RunOptions& options = plan.options;
  auto checkpoint = core::read_checkpoint(options.resume);
  if (!checkpoint.ok()) return complain(kBadInput, checkpoint.error().message);
  plan.resumed = std::move(checkpoint).value();
  const hal::Json& about = plan.resumed->about;
  const std::string name = hal::text_of(hal::object_of(about, "file"), "file");
  const std::string settings = hal::text_of(about, "settings");
  if (settings.empty()) return complain(kBadInput, "checkpoint '" + options.resume + "' has no experiment");
  return plan.reading.open_text(settings, name, options.overrides) ? kDone : kBadInput;
}

/// Whether the run can go on from it with the program and files that there are.
hal::Status check_resumed(const RunPlan& plan) {
  const RunOptions& options = plan.options;
  const core::Checkpoint& checkpoint = *plan.resumed;
  const std::string which = "checkpoint '" + options.resume + "': ";
  const std::string changed = changed_files(checkpoint.about, plan.inputs, !options.overrides.empty());
  if (!changed.empty()) return hal::Error{which + "files are not those of its run:" + changed};
  const hal::Json then = hal::object_of(checkpoint.about, "program"), now = to_json(build_info());
  for (const char* key : {"version", "commit", "compiler", "build"}) {
    const std::string was = hal::text_of(then, key), is = hal::text_of(now, key);
    if (was != is)
      return hal::Error{which + "it was written by another build of this program: its " + key + " is '" + was +
                        "', here '" + is + "'"};
  }
  if (!checkpoint.state.empty()) return {};
  if (checkpoint.touched || !options.overrides.empty() || options.seed)
    return hal::Error{which + "it does not hold the state of its run (" + checkpoint.why_no_state + "), so " +
                      (checkpoint.touched ? "what people did there by hand cannot be done again"
                                          : "--set and --seed cannot change what is computed again")};
  return {};
}

/// The experiment, and the guardian of its real robots: made before any other thread.
int read_experiment(RunPlan& plan) {
  const RunOptions& options = plan.options;
  auto hub_faults = HubFaults::make(options.hub_faults);
  if (!hub_faults.ok()) return complain(kBadInput, hub_faults.error().message);
  plan.hub_faults = std::move(hub_faults).value();
  ReplayRun& replay = plan.replay;
  if (!options.resume.empty()) {
    if (const int code = open_resumed(plan); code != kDone) return code;
  } else if (!(replay.wanted() ? replay.open(plan.reading)
                               : plan.reading.open(options.experiment, options.overrides))) {
    return kBadInput;
  }
  plan.guarded.emplace(!replay.wanted() && plan.reading.has_real_robots(options.without), plan.loader.catalog(),
                       hal::Log([](hal::Severity, std::string_view text) { say(text); }));
  plan.scenario = plan.reading.read();
  if (!plan.scenario) return kBadInput;
  core::Scenario& scenario = *plan.scenario;
  if (const int code = told(leave_out(scenario, options.without)); code != kDone) return code;
  if (replay.wanted() && !replay.prepare(scenario, plan.loader)) return kBadInput;
  if ((!options.checkpoint.empty() || plan.resumed) && has_real_robots(scenario))
    return complain(
        kBadInput,
        "--checkpoint, --resume: real robots take part, which cannot be put back; simulate them (--without)");
  if (!options.hub_faults.empty() && !has_real_robots(scenario))
    return complain(kBadInput, "--hub-fault needs a real robot: no robot of this experiment has a <bridge>");
  if (const int code = told(check_output_paths(options, scenario, plan.loader.catalog())); code != kDone) return code;
  return told(plan.guarded->started(), kFailedRunning);
}

/// What is to be done again; nothing where no record was named.
hal::Result<core::Repeatable> read_repeated(const RunOptions& options, const core::Scenario& scenario) {
  if (options.repeat.empty()) return core::Repeatable{};
  if (has_real_robots(scenario)) {
    return hal::Error{
        "--repeat: real robots take part, and never do the same twice; simulate them instead (--without)"};
  }
  auto repeated = core::read_repeatable(options.repeat);
  if (repeated.ok() && repeated.value().real_robots && options.replay.record.empty())
    return hal::Error{"record '" + options.repeat +
                      "': real robots took part in this run; `tandem replay` computes it again"};
  if (repeated.ok() && repeated.value().experiment != scenario.name)
    say("the record is of the experiment '" + repeated.value().experiment + "'");
  return repeated;
}

/// The repeated run begins with the scripts of the record, whatever stands in their files now.
void run_recorded_scripts(core::World& world, core::Repeatable& repeated) {
  std::vector<core::RepeatedAction> reloads = core::reloads_to(repeated.scripts, world);
  for (const core::RepeatedAction& reload : reloads) {
    say("controller '" + reload.action["controller"].get<std::string>() +
        "' begins with its script as the record has it; the file is another one now");
  }
  repeated.actions.insert(repeated.actions.begin(), std::make_move_iterator(reloads.begin()),
                          std::make_move_iterator(reloads.end()));
}

int make_world(RunPlan& plan) {
  const RunOptions& options = plan.options;
  auto repeated = read_repeated(options, *plan.scenario);
  if (!repeated.ok()) return complain(kBadInput, repeated.error().message);
  plan.repeated = std::move(repeated).value();
  plan.world_log = plan.log.log();
  core::WorldOptions world_options;
  world_options.seed = options.seed ? options.seed : plan.repeated.seed;
  if (plan.resumed && !options.seed) world_options.seed = hal::count_of(plan.resumed->about, "seed");
  world_options.threads = options.threads;
  world_options.log = plan.world_log;
  core::Problems problems;
  plan.made = core::World::make(*plan.scenario, plan.loader, world_options, problems);
  print_problems(problems);
  plan.world = plan.made.get();
  if (plan.world == nullptr) return kBadInput;

  ReplayRun& replay = plan.replay;
  const bool other_scripts = options.replay.accept_changes || (replay.wanted() && replay.changed_from_start());
  if (!other_scripts) run_recorded_scripts(*plan.world, plan.repeated);
  if (replay.wanted() || tells_files(options, *plan.scenario)) plan.inputs = input_files(*plan.scenario, plan.loader);
  plan.steps = steps_of(options.steps, options.seconds, *plan.scenario);
  if (plan.resumed) {
    if (const int code = told(check_resumed(plan)); code != kDone) return code;
  }
  if (!replay.wanted()) return kDone;
  hal::Status joined = replay.check_files(plan.inputs);
  if (joined.ok()) joined = replay.join(*plan.world, plan.world_log);
  if (joined.ok()) plan.steps = replay.steps();
  return told(joined);
}

/// What a record says at its start, with the scripts of controllers.
hal::Json start_of(core::World& world, const InputFiles& inputs) {
  hal::Json start = record_start(world, inputs);
  hal::Json scripts = core::source_files(world);
  for (hal::Json& files : scripts) {
    for (hal::Json& file : files) file.erase("path");
  }
  if (!scripts.empty()) start["scripts"] = std::move(scripts);
  return start;
}

int open_all_outputs(RunPlan& plan) {
  auto opened = open_outputs(
      plan.options, *plan.scenario, *plan.world, plan.loader.catalog(),
      [&plan] { return start_of(*plan.world, plan.inputs); }, plan.steps);
  if (!opened.ok()) return complain(kBadInput, opened.error().message);
  plan.outputs = std::move(opened).value();
  core::Problems problems;
  plan.outputs.observers = Observers::make(*plan.scenario, plan.loader.catalog(), *plan.world, problems);
  print_problems(problems);
  if (core::has_errors(problems)) return kBadInput;
  return told(Watch::check(plan.options.watch, plan.world->space()));
}

}  // namespace

int prepare_run(RunPlan& plan) {
  if (const int code = read_experiment(plan); code != kDone) return code;
  plan.stop = &catch_signals();
  std::signal(SIGPIPE, SIG_IGN);  // who reads our output may end before us
  plan.watchdog.emplace(plan.options.step_timeout_s, *plan.stop, plan.options.step_limit_s);
  if (const int code = told(plan.log.open(plan.options.log)); code != kDone) return code;
  if (const int code = make_world(plan); code != kDone) return code;
  if (const int code = open_all_outputs(plan); code != kDone) return code;
  plan.result.emplace(RunResult{*plan.world, plan.inputs, {}, plan.world->space().robot_count(), {}, nullptr});
  plan.result->figures.threads = plan.world->threads();
  return kDone;
}

}  // namespace tandem::app
