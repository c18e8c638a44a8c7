// `tandem check` on a robot's board: what can be told without a world.
#include <fmt/format.h>

#include "app/command/check.hpp"
#include "app/command/command.hpp"
#include "app/experiment/plugins.hpp"
#include "app/experiment/reading.hpp"
#include "hal/plugin_loader.hpp"

namespace tandem::app {
namespace {

/// Adds what is wrong with a robot's controller: its library, its name there, its parameters.
void check_controller(const core::Scenario& scenario, const core::RobotItem& item, hal::PluginLoader& loader,
                      core::Problems& problems) {
  const core::ControllerConfig& config = scenario.controllers[item.controller];
  const auto type = loader.controller(config.library, config.label);
  if (!type.ok()) {
    problems.push_back({scenario.file, config.line, "controller '" + config.id + "': " + type.error().message});
    return;
  }
  core::ElementReader reader(item.params ? *item.params : config.params, problems);
  (void)type.value()->read_params(reader);
  reader.finish();
}

int check(const CheckOptions& options) {
  hal::PluginLoader loader = make_loader();
  if (!open_plugins(loader, options.plugins)) return kBadInput;
  if (const auto other = check_other_file(options.experiment, loader.catalog())) return *other;
  const auto scenario = read_or_complain(loader, {}, options.experiment, options.overrides);
  if (!scenario) return kBadInput;
  core::Problems problems;
  std::size_t driven = 0;
  for (const core::RobotItem& item : scenario->robots) {
    if (!item.bridge) continue;
    ++driven;
    check_controller(*scenario, item, loader, problems);
  }
  print_problems(problems);
  if (core::has_errors(problems)) return kBadInput;
  fmt::print(
      "{}: good: {} robots with a <bridge>, {} ticks a second; places and simulated devices are not checked here\n",
      options.experiment, driven, scenario->ticks_per_second);
  return kDone;
}

}  // namespace

constinit const hal::CommandType check_command =
    hal::command_type<CheckOptions, check>("check", kCheckSummary, hal::command_group::kSimulate);

}  // namespace tandem::app
