#include <fmt/format.h>

#include "app/catalog.hpp"
#include "app/command/command.hpp"
#include "core/sim/world.hpp"

namespace tandem::app {

int check(const CheckOptions& options) {
  if (const auto other = check_other_file(options.experiment)) return *other;
  const auto scenario = read_or_complain(options.experiment, options.overrides);
  if (!scenario) return kBadInput;
  // What only making the world can tell: libraries, devices, parameters, places.
  hal::PluginLoader loader(plugin_folders(), catalog());
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
