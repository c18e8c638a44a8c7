#include <fmt/format.h>

#include "app/catalog.hpp"
#include "app/command/command.hpp"
#include "core/config/xml.hpp"
#include "core/sim/world.hpp"
#include "mixed_reality/footbot/map_file.hpp"

namespace tandem::app {
namespace {

/// Whether the file is a foot-bot's map, and no experiment.
bool is_map(const std::string& path) {
  core::Problems ignored;
  const auto root = core::read_xml_file(path, ignored);
  return root && root->name == "footbot_map";
}

int check_map(const std::string& path) {
  core::Problems problems;
  const auto map = mixed_reality::read_footbot_map(path, problems);
  print_problems(problems);
  if (!map) return kBadInput;
  std::size_t variables = 0;
  for (const auto& node : map->nodes) variables += node.variables.size();
  fmt::print("{}: good: {} nodes, {} variables\n", path, map->nodes.size(), variables);
  return kDone;
}

}  // namespace

void print_problems(const core::Problems& problems) {
  for (const core::Problem& problem : problems) fmt::print(stderr, "{}\n", core::to_text(problem));
}

std::optional<core::Scenario> read_or_complain(const std::string& path, const std::vector<std::string>& overrides) {
  core::Problems problems;
  auto scenario = core::read_experiment(path, overrides, known_names(), problems);
  print_problems(problems);
  return scenario;
}

int check(const CheckOptions& options) {
  if (is_map(options.experiment)) return check_map(options.experiment);
  const auto scenario = read_or_complain(options.experiment, options.overrides);
  if (!scenario) return kBadInput;
  // What only making the world can tell: libraries, devices, parameters, places.
  hal::PluginLoader loader(plugin_folders());
  core::Problems problems;
  core::WorldOptions world_options;
  if (!scenario->seed) world_options.seed = 1;
  const auto world = core::World::make(*scenario, loader, world_options, problems);
  print_problems(problems);
  if (world == nullptr) return kBadInput;
  fmt::print("{}: good: {} robots, {} objects, {} controller configurations, {} ticks a second\n", options.experiment,
             world->space().robot_count(), world->space().objects().size(), scenario->controllers.size(),
             scenario->ticks_per_second);
  return kDone;
}

}  // namespace tandem::app
