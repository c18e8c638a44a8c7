#include "app/command/check.hpp"

#include <fmt/format.h>

#include "app/command/command.hpp"
#include "app/experiment/plugins.hpp"
#include "app/experiment/reading.hpp"
#include "core/sim/world.hpp"
#include "hal/xml/xml.hpp"
#include "mixed_reality/settings/tracker_check.hpp"

namespace tandem::app {
namespace {

int check(const CheckOptions& options) {
  core::Problems unread;  // told below
  if (const auto root = hal::read_xml_file(options.experiment, unread); root && root->name == "study")
    return check_study(options.experiment, options.plugins);
  hal::PluginLoader loader = make_loader();
  if (!open_plugins(loader, options.plugins)) return kBadInput;
  if (const auto other = check_other_file(options.experiment, loader.catalog())) return *other;
  const auto scenario = read_or_complain(loader, {}, options.experiment, options.overrides);
  if (!scenario) return kBadInput;
  // What only making the world can tell: libraries, devices, parameters, places.
  core::Problems problems;
  core::WorldOptions world_options;
  if (!scenario->seed) world_options.seed = 1;
  const auto world = core::World::make(*scenario, loader, world_options, problems);
  print_problems(problems);
  if (world == nullptr) return kBadInput;
  for (const std::string& outlook : mixed_reality::outlooks(*scenario, loader.catalog())) fmt::print("{}\n", outlook);
  fmt::print("{}: good: {} robots, {} objects, {} controller configurations, {} ticks a second\n", options.experiment,
             world->space().robot_count(), world->space().objects().size(), scenario->controllers.size(),
             scenario->ticks_per_second);
  return kDone;
}

}  // namespace

constinit const hal::CommandType check_command = hal::command_type<CheckOptions, check>("check", kCheckSummary);

}  // namespace tandem::app
