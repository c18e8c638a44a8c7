#include "library/open_world.hpp"

#include "app/catalog.hpp"
#include "app/experiment/plugin_folders.hpp"
#include "app/module/modules.hpp"
#include "app/outputs/run_record.hpp"
#include "core/config/reader.hpp"
#include "core/run/named_parts.hpp"
#include "hal/xml/xml.hpp"

namespace tandem::library {
namespace {

std::string errors_of(const core::Problems& problems) {
  std::string text;
  for (const core::Problem& problem : problems) {
    if (!problem.warning) text += (text.empty() ? "" : "\n") + core::to_text(problem);
  }
  return text;
}

bool open_plugins(hal::PluginLoader& loader, const WorldRequest& request, const core::Element& root,
                  core::Problems& problems) {
  for (const std::string& library : request.plugins) {
    if (const hal::Status opened = loader.open(library); !opened.ok())
      problems.push_back({request.file, 0, opened.error().message, false});
  }
  for (const core::PluginConfig& plugin : core::plugins_of(root)) {
    if (const hal::Status opened = loader.open(plugin.library); !opened.ok())
      problems.push_back({request.file, plugin.line, "<plugins>: " + opened.error().message, false});
  }
  return !core::has_errors(problems);
}

}  // namespace

std::optional<core::Scenario> read_scenario(hal::PluginLoader& loader, const WorldRequest& request,
                                            core::Problems& problems) {
  loader.look_beside(request.file);
  std::optional<core::Scenario> scenario;
  if (request.text.empty()) {
    auto file = core::open_experiment(request.file, request.parameters, problems);
    if (!file || !open_plugins(loader, request, file->root, problems)) return {};
    scenario = core::read_experiment(std::move(*file), loader.catalog(), problems);
  } else {
    core::Problems malformed;  // told by the reader below
    const auto root = hal::read_xml_text(request.text, request.file, malformed);
    if (root && !open_plugins(loader, request, *root, problems)) return {};
    scenario = core::read_experiment_text(request.text, request.file, request.parameters, loader.catalog(), problems);
  }
  if (!scenario || core::has_errors(problems)) return {};
  for (core::RobotItem& robot : scenario->robots) robot.bridge.reset();
  return scenario;
}

void add_parts(core::Run& run, hal::PluginLoader& loader, const std::string& record, core::Problems& problems) {
  core::add_named_parts(run, loader.catalog(), problems);
  if (record.empty()) return;
  auto opened = app::RecordPart::open(run.world(), loader, record);
  if (opened.ok())
    run.add(std::move(opened).value());
  else
    problems.push_back({run.world().scenario().file, 0, opened.error().message, false});
}

hal::Result<std::unique_ptr<OpenWorld>> open_world(const WorldRequest& request) {
  std::unique_ptr<hal::PluginLoader> loader(
      new hal::PluginLoader(app::plugin_folders(), app::catalog(), app::on_demand()));
  core::Problems problems;
  const auto scenario = read_scenario(*loader, request, problems);
  if (!scenario) return hal::Error{errors_of(problems)};
  core::WorldOptions options;
  options.seed = request.seed;
  options.threads = request.threads;
  options.log = request.log;
  auto world = core::World::make(*scenario, *loader, options, problems);
  if (world == nullptr) return hal::Error{errors_of(problems)};
  auto opened = std::make_unique<OpenWorld>(std::move(loader), std::move(world), std::move(problems));
  core::Problems of_parts;
  add_parts(opened->run(), opened->loader(), request.record, of_parts);
  if (core::has_errors(of_parts)) return hal::Error{errors_of(of_parts)};
  return opened;
}

}  // namespace tandem::library
