#include "app/study/sweep_plan.hpp"

#include <algorithm>
#include <cerrno>
#include <cstdio>
#include <fmt/format.h>
#include <set>
#include <sys/wait.h>
#include <unistd.h>

#include "app/build_info.hpp"
#include "app/exit_code.hpp"
#include "app/experiment/plugins.hpp"
#include "app/experiment/reading.hpp"
#include "app/outputs/run_report.hpp"
#include "app/process/terminal.hpp"
#include "core/config/reader.hpp"
#include "core/hook/hook.hpp"
#include "core/sim/settings.hpp"
#include "core/sim/world.hpp"
#include "hal/sha256.hpp"

namespace tandem::app {
namespace {

constexpr std::size_t kJudgedValues = 200;  // of one parameter

std::optional<core::Scenario> read(const std::string& file, const std::vector<std::string>& overrides,
                                   hal::PluginLoader& loader, core::Problems& problems) {
  loader.look_beside(file);
  auto opened = core::open_experiment(file, overrides, problems);
  if (!opened) return std::nullopt;
  auto scenario = core::read_experiment(std::move(*opened), loader.catalog(), problems);
  if (!scenario) return std::nullopt;
  for (core::RobotItem& robot : scenario->robots) robot.bridge.reset();
  return scenario;
}

/// Problems with "--set path=value" as problems of the study's line that says so. Only the first of each line is kept.
core::Problems of_study(const study::Study& study, const study::ExperimentChoice& experiment, core::Problems problems) {
  const auto move = [&](core::Problem& problem, const std::string& path, int line, const std::string& what) {
    const std::string begin = "--set " + path + "=";
    if (!problem.file.starts_with(begin)) return;
    problem.message = fmt::format("{} = {}, in experiment '{}': {}", what, problem.file.substr(begin.size()),
                                  experiment.name, problem.message);
    problem.file = study.file;
    problem.line = line;
  };
  for (core::Problem& problem : problems) {
    for (const study::Constant& c : study.constants) move(problem, c.path, c.line, "<set> " + c.path);
    for (const study::Parameter* p : study.parameters()) move(problem, p->path, p->line, "parameter " + p->name);
  }
  std::set<std::pair<std::string, int>> seen;
  std::erase_if(problems, [&](const core::Problem& problem) {
    return problem.warning || (problem.line > 0 && !seen.emplace(problem.file, problem.line).second);
  });
  return problems;
}

/// What parameters of controllers and hooks say to their settings, without making any.
void judge_settings(const core::Scenario& scenario, hal::PluginLoader& loader, core::Problems& problems) {
  const auto read_params = [&](const core::Element& params, const hal::ControllerType& type) {
    core::ElementReader reader(params, problems);
    (void)type.read_params(reader);
    reader.finish();
  };
  try {
    for (std::size_t i = 0; i < scenario.controllers.size(); ++i) {
      const core::ControllerConfig& config = scenario.controllers[i];
      auto type = loader.controller(config.library, config.label);
      if (!type.ok()) continue;  // told when the world is made, and so is what throws
      read_params(config.params, **type);
      for (const core::RobotItem& robot : scenario.robots) {
        if (robot.controller == i && robot.params) read_params(*robot.params, **type);
      }
    }
    for (const core::HookConfig& hook : scenario.hooks) {
      auto type = loader.get<core::HookType>(hook.library, hook.label);
      if (!type.ok() || (*type)->describe == nullptr) continue;
      core::ElementReader reader(hook.options, problems, {"library", "label"});
      (*type)->describe(reader);
      reader.finish();
    }
  } catch (...) {
  }
}

/// The runs that show every value of every parameter in one experiment, others as in the first run.
std::vector<std::vector<std::string>> shown_values(const study::Design& design, std::size_t experiment) {
  const std::int64_t points = design.configurations() / static_cast<std::int64_t>(design.study().experiments.size());
  const std::vector<std::string> first = design.overrides(design.run(static_cast<std::int64_t>(experiment) * points));
  std::vector<std::vector<std::string>> all;
  std::size_t at = design.study().constants.size();
  for (const study::Parameter* p : design.study().parameters()) {
    const std::size_t n = p->values.size();
    const std::size_t step = std::max<std::size_t>(1, n / kJudgedValues);
    for (std::size_t i = 1; i < n; i += step) {
      all.push_back(first);
      all.back()[at] = p->path + "=" + p->values[i];
    }
    ++at;
  }
  return all;
}

/// In a process of its own, so that this one has run no code of plug-ins when it forks its workers.
bool can_be_made(const core::Scenario& scenario, hal::PluginLoader& loader) {
  std::fflush(nullptr);
  const pid_t child = fork();
  if (child < 0) return true;  // the runs will tell
  if (child == 0) {
    core::Problems problems;
    core::WorldOptions options;
    options.seed = scenario.seed.value_or(1);
    options.threads = 0;
    const auto world = core::World::make(scenario, loader, options, problems);
    std::erase_if(problems, [](const core::Problem& problem) { return problem.warning; });
    print_problems(problems);
    _exit(world != nullptr ? kDone : kBadInput);
  }
  int status = 0;
  while (waitpid(child, &status, 0) < 0 && errno == EINTR) {
  }
  return WIFEXITED(status) && WEXITSTATUS(status) == kDone;
}

}  // namespace

hal::Result<core::Scenario> scenario_of(const study::Design& design, const study::RunPlan& plan,
                                        hal::PluginLoader& loader) {
  core::Problems problems;
  auto scenario = read(design.study().experiments[plan.experiment].file, design.overrides(plan), loader, problems);
  if (scenario) return std::move(*scenario);
  return hal::Error{core::errors_of(problems)};
}

std::optional<std::vector<core::Scenario>> judge(const study::Design& design, hal::PluginLoader& loader,
                                                 const std::vector<std::string>& plugins) {
  const study::Study& study = design.study();
  std::vector<core::Scenario> scenarios;
  bool good = open_plugins(loader, plugins);
  for (std::size_t i = 0; i < study.experiments.size(); ++i) {
    const study::ExperimentChoice& experiment = study.experiments[i];
    ExperimentReading reading(loader, {});
    if (!reading.open(experiment.file, {}) || !reading.read()) {  // opens its plug-ins; warnings are told once, here
      good = false;
      continue;
    }
    const std::int64_t points = design.configurations() / static_cast<std::int64_t>(study.experiments.size());
    core::Problems problems;
    auto scenario =
        read(experiment.file, design.overrides(design.run(static_cast<std::int64_t>(i) * points)), loader, problems);
    core::Problems of_values;
    if (scenario) judge_settings(*scenario, loader, of_values);
    for (const std::vector<std::string>& overrides : shown_values(design, i)) {
      if (const auto shown = read(experiment.file, overrides, loader, of_values))
        judge_settings(*shown, loader, of_values);
    }
    for (core::Problem& problem : of_values) {
      if (problem.file.starts_with("--set ")) problems.push_back(std::move(problem));
    }
    problems = of_study(study, experiment, std::move(problems));
    if (scenario && scenario->length_s == 0.0 && scenario->hooks.empty()) {
      problems.push_back({study.file, experiment.line,
                          "experiment '" + experiment.name +
                              "' never ends: it has no length, and no hook that could end it; add <set "
                              "path=\"framework.experiment.length\" value=\"…\"/>",
                          false});
    }
    print_problems(problems);
    if (!scenario || core::has_errors(problems) || !can_be_made(*scenario, loader))
      good = false;
    else
      scenarios.push_back(std::move(*scenario));
  }
  if (!good) return std::nullopt;
  return scenarios;
}

study::Version version_of(const std::vector<core::Scenario>& experiments, const hal::PluginLoader& loader) {
  study::Version version;
  version.program = version_text();
  std::set<std::string> seen;
  const auto add = [&](const InputFile& file) {
    if (seen.insert(file.file).second) version.files.emplace_back(file.file, file.sha256);
  };
  const auto program = hal::sha256_of_file("/proc/self/exe");
  version.files.emplace_back("tandem", program.ok() ? program.value() : "");
  for (const core::Scenario& scenario : experiments) {
    const InputFiles files = input_files(scenario, loader);
    add(files.experiment);
    for (const auto* list : {&files.plugins, &files.controllers, &files.hooks, &files.others}) {
      for (const InputFile& file : *list) add(file);
    }
  }
  return version;
}

hal::Status check_same_runs(const study::Design& design, const study::TableHead& head,
                            const std::vector<study::KnownRun>& known) {
  std::vector<std::string> names;
  for (const study::Parameter* p : design.study().parameters()) names.push_back(p->name);
  const std::string help = "; choose another table with --table, or take the study as it was";
  if (names != head.settings) return hal::Error{"the table's study varies other parameters" + help};
  for (const study::KnownRun& run : known) {
    bool same = run.run < design.runs();
    if (same) {
      const study::RunPlan plan = design.run(run.run);
      const std::vector<std::string> values = design.values(plan.point);
      same = design.study().experiments[plan.experiment].name == run.experiment && plan.seed == run.seed;
      for (std::size_t i = 0; same && i < values.size(); ++i) same = study::same_setting(run.settings[i], values[i]);
    }
    if (!same)
      return hal::Error{fmt::format("the study has changed since the table was begun: its run {} is another one now{}",
                                    run.run, help)};
  }
  return {};
}

hal::Status check_same_version(const study::Version& then, const study::Version& now) {
  std::string changed = then.program == now.program ? "" : "the program (" + then.program + ")";
  for (const auto& [file, sha256] : now.files) {
    const auto before =
        std::find_if(then.files.begin(), then.files.end(), [&file = file](const auto& f) { return f.first == file; });
    if (before != then.files.end() && before->second == sha256) continue;
    if (file == "tandem" && !changed.empty()) continue;
    changed += (changed.empty() ? "" : ", ") + (file == "tandem" ? std::string("the program") : "'" + file + "'");
  }
  if (changed.empty()) return {};
  return hal::Error{"since the table was begun there have been changes: " + changed +
                    ". --accept-changes makes the other runs with what is there now, and notes that in the column "
                    "'version'; --table begins another one"};
}

std::string command_of(const study::Design& design, const study::RunPlan& plan) {
  std::string command = "tandem run " + shell_word(design.study().experiments[plan.experiment].file) + " --seed " +
                        std::to_string(plan.seed);
  for (const std::string& assignment : design.overrides(plan)) command += " --set " + shell_word(assignment);
  return command;
}

}  // namespace tandem::app
