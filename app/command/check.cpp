#include "app/command/check.hpp"

#include <fmt/format.h>

#include "app/command/command.hpp"
#include "app/experiment/plugins.hpp"
#include "app/experiment/reading.hpp"
#include "app/experiment/real_side_type.hpp"
#include "core/sim/world.hpp"
#include "hal/xml/xml.hpp"

namespace tandem::app {
namespace {

int check(const CheckOptions& options) {
  hal::PluginLoader loader = make_loader();
  core::Problems unread;  // told below
  if (const auto root = hal::read_xml_file(options.experiment, unread)) {
    if (!need_modules_for(loader, *root)) return kBadInput;
    const auto* const type = loader.catalog().find<CheckedFile>(root->name);
    if (type != nullptr) return type->check(options.experiment, options.plugins);
  }
  if (!open_plugins(loader, options.plugins)) return kBadInput;
  if (const auto other = check_other_file(options.experiment, loader.catalog())) return *other;
  const auto scenario = read_or_complain(loader, {}, options.experiment, options.all_overrides(), options.strict);
  if (!scenario) return kBadInput;
  // What only making the world can tell: libraries, devices, parameters, places.
  core::Problems problems;
  core::WorldOptions world_options;
  if (!scenario->seed) world_options.seed = 1;
  const auto world = core::World::make(*scenario, loader, world_options, problems);
  if (options.strict) core::refuse_ignored(problems);
  print_problems(problems);
  if (world == nullptr || core::has_errors(problems)) return kBadInput;
  for (const RealSideType* real : loader.catalog().all<RealSideType>()) {
    for (const std::string& outlook : real->outlooks(*scenario, loader.catalog())) fmt::print("{}\n", outlook);
  }
  fmt::print("{}: good: {} robots, {} objects, {} controller configurations, {} ticks a second\n", options.experiment,
             world->space().robot_count(), world->space().objects().size(), scenario->controllers.size(),
             scenario->ticks_per_second);
  return kDone;
}

}  // namespace

constinit const hal::CommandType check_command =
    hal::command_type<CheckOptions, check>("check", kCheckSummary, hal::command_group::kSimulate);

}  // namespace tandem::app
