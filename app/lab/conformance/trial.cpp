#include "app/lab/conformance/trial.hpp"

#include <algorithm>
#include <fmt/format.h>

#include "app/lab/conformance/probe.hpp"
#include "core/config/reader.hpp"
#include "hal/markup.hpp"

namespace tandem::app {
namespace {

constexpr int kGroups = 24;  // from 16 blocks on a world's threads share the work; a group has one
constexpr int kRobotsAGroup = 4;
constexpr int kColumns = 12;

std::string devices_of(const Trial& trial, hal::Role role) {
  std::string text;
  for (const core::DeviceType* type : trial.devices) {
    if (type->role == role)
      text += fmt::format("<{} implementation=\"{}\"/>", type->device, hal::escaped_markup(type->implementation));
  }
  return text;
}

/// Robots in a grid; before every fifth of those on wheels a box, which moves where the engine moves any.
std::string arena_of(const Trial& trial, const core::EngineType& engine) {
  const double radius_m = trial.kind->body.radius_m;
  const double spacing_m = std::max(0.3, 6.0 * radius_m);
  const double size_m = spacing_m * (kColumns + 4);
  std::string text = fmt::format("<arena size=\"{0},{0},{1}\" escape=\"stop\">", size_m, 10.0 + spacing_m);
  text += fmt::format("<light id=\"lamp0\" position=\"0,0,1\"/><light id=\"lamp1\" position=\"{},1,1\"/>", spacing_m);
  text += "<sound id=\"hum\" position=\"1,0,0\"/>";
  for (int i = 0; i < kGroups * kRobotsAGroup; ++i) {
    const double x_m = spacing_m * (i % kColumns - 0.5 * (kColumns - 1));
    const double y_m = spacing_m * (i / kColumns - 0.5 * (kGroups * kRobotsAGroup / kColumns - 1));
    const bool box = i % 5 == 0 && !trial.kind->flies();
    text += fmt::format(
        "<{0} id=\"r{1}\"><body position=\"{2},{3},{4}\" orientation=\"{5},0,0\"/><controller config=\"c{6}\"/></{0}>",
        trial.kind->name, i, x_m, y_m, trial.kind->flies() ? 1.0 + 0.02 * i : 0.0, box ? 0 : 37 * i % 360, i % kGroups);
    if (box)
      text += fmt::format(
          "<box id=\"b{0}\" size=\"{1},{1},{1}\" movable=\"{2}\" mass=\"0.2\"><body position=\"{3},{4},0\"/></box>", i,
          radius_m, engine.traits.forces, x_m + 1.6 * radius_m, y_m);
  }
  return text + "</arena>";
}

}  // namespace

const core::EngineType* engine_for(const hal::Catalog& catalog, const Trial& trial) {
  core::JointKinds joints = 0;
  for (const core::DeviceType* type : trial.devices) joints = static_cast<core::JointKinds>(joints | type->joints);
  const bool flies = trial.kind->flies();
  for (const core::EngineType* type : catalog.all<core::EngineType>()) {
    if (trial.engine.empty() ? type->traits.has(joints) && (!flies || !type->traits.plane) : type->kind == trial.engine)
      return type;
  }
  return nullptr;
}

TrialMaker::TrialMaker(hal::PluginLoader& loader, const Trial& trial) : loader_(loader) {
  const core::EngineType* const engine = engine_for(loader.catalog(), trial);
  if (engine == nullptr) {
    flaw_ = "there is no engine here that has what it needs";
    return;
  }
  for (const core::DeviceType* type : trial.devices) {
    const auto* const port = loader.catalog().find<hal::PortType>(hal::port_entry(type->device, type->role));
    if (port == nullptr) {
      flaw_ = "the " + hal::port_entry(type->device, type->role) + " is no port: register hal::port_type<…>()";
      return;
    }
    ports_.push_back(port);
  }
  const std::string label = trial.controller.empty() ? std::string(kProbe) : trial.controller;
  const std::string library = trial.controller.empty() ? std::string(hal::Catalog::kInside) : trial.library;
  text_ =
      "<tandem version=\"1\"><framework><experiment length=\"0\" ticks_per_second=\"10\" random_seed=\"7\"/>"
      "</framework><controllers>";
  for (int i = 0; i < kGroups; ++i)
    text_ += fmt::format("<{0} id=\"c{1}\" library=\"{2}\"><sensors>{3}</sensors><actuators>{4}</actuators></{0}>",
                         label, i, hal::escaped_markup(library), devices_of(trial, hal::Role::Sensor),
                         devices_of(trial, hal::Role::Actuator));
  text_ += fmt::format("</controllers><physics_engines><{} id=\"engine\" {}/></physics_engines>", engine->kind,
                       trial.engine_options);
  text_ += arena_of(trial, *engine) + trial.more + "</tandem>";
}

std::unique_ptr<core::World> TrialMaker::make(std::int64_t threads, std::string& why) const {
  why = flaw_;
  if (!why.empty()) return nullptr;
  set_probe_ports(ports_);
  core::Problems problems;
  auto scenario = core::read_experiment_text(text_, "trial", {}, loader_.catalog(), problems);
  core::WorldOptions options;
  options.threads = threads;
  std::unique_ptr<core::World> world;
  if (scenario) world = core::World::make(*scenario, loader_, options, problems);
  if (world != nullptr) {
    world->start();
    return world;
  }
  why = "it cannot be made";
  for (const core::Problem& p : problems) {
    if (!p.warning) {
      why = p.message;
      break;
    }
  }
  return nullptr;
}

std::string step_to(core::World& world, std::int64_t until) {
  while (world.tick() < until && world.state() == core::RunState::Running) world.step();
  return world.failure();
}

}  // namespace tandem::app
