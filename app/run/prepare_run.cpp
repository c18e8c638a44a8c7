#include <algorithm>
#include <csignal>
#include <utility>

#include "app/build_info.hpp"
#include "app/experiment/reading.hpp"
#include "app/module/modules.hpp"
#include "app/outputs/run_record.hpp"
#include "app/process/signals.hpp"
#include "app/process/terminal.hpp"
#include "app/run/run_plan.hpp"
#include "hal/json/json_access.hpp"

namespace tandem::app {
namespace {

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
  return plan.reading.open_text(settings, name, options.all_overrides()) ? kDone : kBadInput;
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

/// Modules whose parts the options ask for.
int need_modules(RunPlan& plan) {
  const RunOptions& o = plan.options;
  const PictureRequest& p = o.pictures;
  const bool draws = !p.picture.empty() || !p.film.empty() || !p.povray.empty() || !p.layers.empty();
  const std::pair<const char*, bool> wanted[] = {
      {"live", is_held(o)}, {"pictures", draws || o.view.on}, {"window", o.view.on}};
  for (const auto& [name, is] : wanted) {
    if (!is) continue;
    if (const int code = need_for_run(plan, name); code != kDone) return code;
  }
  return kDone;
}

/// What is not simulated, where the file or the options ask for it.
int make_side(RunPlan& plan) {
  const auto types = plan.loader.catalog().all<RealSideType>();
  if (plan.side != nullptr || types.empty()) return kDone;
  auto made = types.front()->make(plan);
  if (!made.ok()) return complain(kBadInput, made.error().message);
  plan.side = std::move(made).value();
  return kDone;
}

int open_experiment(RunPlan& plan) {
  const RunOptions& options = plan.options;
  if (!options.resume.empty()) {
    const int code = open_resumed(plan);
    return code == kDone ? make_side(plan) : code;
  }
  if (!plan.replays() && options.hub_faults.empty())
    return plan.reading.open(options.experiment, options.all_overrides()) ? make_side(plan) : kBadInput;
  if (const hal::Status real = need_module(plan.loader, "real"); !real.ok())
    return complain(kBadInput, real.error().message);
  if (const int code = make_side(plan); code != kDone) return code;
  const bool opened =
      plan.replays() ? plan.side->open(plan.reading) : plan.reading.open(options.experiment, options.all_overrides());
  return opened ? kDone : kBadInput;
}

/// Whether files that are going to be written are apart from each other, and from all that is read.
int check_paths(const RunPlan& plan) {
  std::vector<NamedFile> outputs, inputs;
  for (const RunModule* module : plan.modules) {
    if (module->outputs == nullptr) continue;
    auto files = module->outputs(plan.options);
    if (!files.ok()) return complain(kBadInput, files.error().message);
    outputs.insert(outputs.end(), files.value().begin(), files.value().end());
  }
  for (const RealSideType* real : plan.loader.catalog().all<RealSideType>()) {
    for (const RealSideType::Input& input : real->inputs(*plan.scenario, plan.loader.catalog()))
      inputs.push_back({input.what, input.path});
  }
  return told(check_output_paths(plan.options, *plan.scenario, std::move(outputs), inputs));
}

int for_modules(RunPlan& plan, int (*RunModule::*hook)(RunPlan&)) {
  for (const RunModule* module : plan.modules) {
    if (module->*hook == nullptr) continue;
    if (const int code = (module->*hook)(plan); code != kDone) return code;
  }
  return kDone;
}

/// The experiment, and the guardian of its real robots: made before any other thread.
int read_experiment(RunPlan& plan) {
  if (const int code = open_experiment(plan); code != kDone) return code;
  if (const int code = need_modules(plan); code != kDone) return code;
  if (plan.side != nullptr) plan.side->guard();
  plan.scenario = plan.reading.read();
  if (!plan.scenario) return kBadInput;
  if (const int code = told(leave_out(*plan.scenario, plan.options.without)); code != kDone) return code;
  if (plan.side != nullptr) {
    if (const int code = plan.side->prepare(*plan.scenario); code != kDone) return code;
  }
  if ((!plan.options.checkpoint.empty() || plan.resumed) && has_real_robots(*plan.scenario))
    return complain(
        kBadInput,
        "--checkpoint, --resume: real robots take part, which cannot be put back; simulate them (--without)");
  if (has_real_robots(*plan.scenario)) {
    if (const int code = need_for_run(plan, "live"); code != kDone) return code;
  }
  return check_paths(plan);
}

int make_world(RunPlan& plan) {
  const RunOptions& options = plan.options;
  if (const int code = for_modules(plan, &RunModule::begin); code != kDone) return code;
  plan.world_log = plan.log.log();
  core::WorldOptions world_options;
  world_options.seed = options.seed ? options.seed : plan.seed;
  if (plan.resumed) world_options.places_seed = hal::count_of(plan.resumed->about, "seed");
  world_options.threads = options.threads;
  world_options.log = plan.world_log;
  world_options.excess_log = plan.log.excess();
  core::Problems problems;
  plan.made = core::World::make(*plan.scenario, plan.loader, world_options, problems);
  print_problems(problems);
  plan.world = plan.made.get();
  if (plan.world == nullptr) return kBadInput;
  if (plan.replays() || tells_files(options, *plan.scenario)) plan.inputs = input_files(*plan.scenario, plan.loader);
  plan.steps = steps_of(options.steps, options.seconds, *plan.scenario);
  if (plan.resumed) {
    if (const int code = told(check_resumed(plan)); code != kDone) return code;
  }
  if (plan.side != nullptr) {
    if (const int code = plan.side->join(); code != kDone) return code;
  }
  return for_modules(plan, &RunModule::prepare);
}

int open_all_outputs(RunPlan& plan) {
  auto opened = open_outputs(plan.options, *plan.scenario, *plan.world,
                             [&plan] { return start_of_record(*plan.world, plan.inputs); });
  if (!opened.ok()) return complain(kBadInput, opened.error().message);
  RunOutputs& outputs = opened.value();
  outputs.at_the_end = std::move(plan.outputs.at_the_end);
  plan.outputs = std::move(outputs);
  core::Problems problems;
  plan.outputs.observers = Observers::make(*plan.scenario, plan.loader.catalog(), *plan.world, problems);
  print_problems(problems);
  return core::has_errors(problems) ? kBadInput : kDone;
}

}  // namespace

const RunModule* module_of(const RunPlan& plan, std::string_view name) noexcept {
  const auto found = std::ranges::find(plan.modules, name, &RunModule::name);
  return found == plan.modules.end() ? nullptr : *found;
}

int need_for_run(RunPlan& plan, std::string_view name) {
  if (module_of(plan, name) != nullptr) return kDone;
  if (const hal::Status loaded = need_module(plan.loader, name); !loaded.ok())
    return complain(kBadInput, loaded.error().message);
  const auto* const module = plan.loader.catalog().find<RunModule>(name);
  if (module != nullptr) plan.modules.push_back(module);
  return kDone;
}

int prepare_run(RunPlan& plan) {
  if (const int code = read_experiment(plan); code != kDone) return code;
  plan.stop = &catch_signals();
  std::signal(SIGPIPE, SIG_IGN);  // who reads our output may end before us
  plan.watchdog.emplace(plan.options.step_timeout_s, *plan.stop, plan.options.step_limit_s);
  if (const int code = told(plan.log.open(plan.options.log)); code != kDone) return code;
  if (const int code = make_world(plan); code != kDone) return code;
  if (const int code = open_all_outputs(plan); code != kDone) return code;
  plan.result.emplace(RunResult{*plan.world, plan.inputs, {}, plan.world->space().robot_count(), {}});
  plan.result->figures.threads = plan.world->threads();
  return kDone;
}

}  // namespace tandem::app
