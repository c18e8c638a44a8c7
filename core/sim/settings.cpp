#include "core/sim/settings.hpp"

#include <algorithm>
#include <limits>

#include "core/device/device.hpp"
#include "core/hook/hook.hpp"
#include "core/physics/solver.hpp"
#include "hal/open_params.hpp"

namespace tandem::core {
namespace {

/// Makes the paths of an element such that whoever reads it elsewhere finds the same files.
class PathResolver final : public hal::ParamVisitor {
 public:
  explicit PathResolver(Element& element) : element_(element) {}

  void visit(const hal::Param& param) override {
    if (param.as<std::string>() == nullptr) return;
    if (param.name != hal::kPathParam) {
      last_ = param.name;
      return;
    }
    for (Element::Attribute& a : element_.attributes) {
      if (a.name == last_) a.value = hal::path_beside(a.value, element_.file);
    }
  }

 private:
  Element& element_;
  std::string last_;  // name of the text before
};

/// Adds to an element what is described and left out there. A description that throws leaves it as it is: it was read
/// before, so nothing depends on it.
template <class Describe>
void complete(Element& element, Describe&& describe) {
  Element completed = element;
  ElementWriter writer(completed);
  try {
    describe(writer);
    PathResolver paths(completed);
    describe(paths);
    element = std::move(completed);
  } catch (...) {
  }
}

Element* child_of(Element& parent, std::string_view name) {
  const auto found = std::find_if(parent.children.begin(), parent.children.end(),
                                  [&](const Element& child) { return child.name == name; });
  return found == parent.children.end() ? nullptr : &*found;
}

void set_attribute(Element& element, std::string_view name, const std::string& value) {
  for (Element::Attribute& a : element.attributes) {
    if (a.name != name) continue;
    a.value = value;
    return;
  }
  element.attributes.push_back({std::string(name), value, 0});
}

/// The file's own element, with what has been completed in its place.
void put(Element& parent, Element completed) {
  Element* there = child_of(parent, completed.name);
  if (there == nullptr)
    parent.children.push_back(std::move(completed));
  else
    *there = std::move(completed);
}

void complete_devices(const hal::Catalog& catalog, std::vector<DeviceChoice>& choices, hal::Role role) {
  for (DeviceChoice& choice : choices) {
    const DeviceType* type = find_device(catalog, choice.device, role, choice.implementation);
    if (type == nullptr) continue;
    complete(choice.options, type->describe);
  }
}

void put_devices(Element& configuration, std::string_view list, const std::vector<DeviceChoice>& choices) {
  Element* there = child_of(configuration, list);
  const auto of_file = std::count_if(choices.begin(), choices.end(), [](const DeviceChoice& c) { return !c.grown; });
  if (there == nullptr || there->children.size() != static_cast<std::size_t>(of_file)) return;
  auto at = there->children.begin();
  for (const DeviceChoice& choice : choices) {
    if (!choice.grown) *at++ = choice.options;
  }
}

void complete_controllers(Scenario& scenario, hal::PluginLoader& loader) {
  std::vector<const hal::ControllerType*> types(scenario.controllers.size(), nullptr);
  for (RobotItem& robot : scenario.robots) {
    ControllerConfig& config = scenario.controllers[robot.controller];
    const hal::ControllerType*& type = types[robot.controller];
    if (type == nullptr) {
      const auto found = loader.controller(config.library, config.label);
      if (!found.ok()) continue;
      type = found.value();
      complete_devices(loader.catalog(), config.sensors, hal::Role::Sensor);
      complete_devices(loader.catalog(), config.actuators, hal::Role::Actuator);
      complete(config.params, type->read_params);
    }
    if (!robot.params) continue;
    complete(*robot.params, type->read_params);
  }
  Element* all = child_of(scenario.effective, "controllers");
  if (all == nullptr || all->children.size() != scenario.controllers.size()) return;
  for (std::size_t i = 0; i < types.size(); ++i) {
    if (types[i] == nullptr) continue;
    put_devices(all->children[i], "sensors", scenario.controllers[i].sensors);
    put_devices(all->children[i], "actuators", scenario.controllers[i].actuators);
    put(all->children[i], scenario.controllers[i].params);
  }
}

/// Robots lie in <arena> in the order in which the reader met them, some in <distribute><entity>.
void put_params_of_robots(Scenario& scenario) {
  Element* arena = child_of(scenario.effective, "arena");
  if (arena == nullptr) return;
  std::size_t next = 0;
  const auto visit = [&](Element& e) {
    if (next == scenario.robots.size() || e.name != scenario.robots[next].kind) return;
    const RobotItem& robot = scenario.robots[next++];
    Element* controller = child_of(e, "controller");
    if (controller != nullptr && robot.params) put(*controller, *robot.params);
  };
  for (Element& e : arena->children) {
    Element* entity = e.name == "distribute" ? child_of(e, "entity") : nullptr;
    if (entity == nullptr)
      visit(e);
    else if (!entity->children.empty())
      visit(entity->children.front());
  }
}

void complete_engines(Scenario& scenario, const hal::Catalog& catalog) {
  for (EngineConfig& engine : scenario.engines) {
    const auto* const type = catalog.find<EngineType>(engine.kind);
    if (type != nullptr && type->describe != nullptr) complete(engine.options, type->describe);
  }
  Element* all = child_of(scenario.effective, "physics_engines");
  if (all == nullptr || all->children.size() != scenario.engines.size()) return;
  for (std::size_t i = 0; i < scenario.engines.size(); ++i) all->children[i] = scenario.engines[i].options;
}

void complete_hooks(Scenario& scenario, hal::PluginLoader& loader) {
  for (HookConfig& hook : scenario.hooks) {
    const auto found = loader.get<HookType>(hook.library, hook.label);
    if (!found.ok()) continue;
    const HookType* type = found.value();
    set_attribute(hook.options, "label", std::string(type->name));
    if (type->describe != nullptr) complete(hook.options, type->describe);
  }
  std::size_t next = 0;
  for (Element& e : scenario.effective.children) {
    if (e.name == "loop_functions" && next < scenario.hooks.size()) e = scenario.hooks[next++].options;
  }
}

void put_seed(Scenario& scenario, std::uint64_t seed) {
  Element* framework = child_of(scenario.effective, "framework");
  Element* experiment = framework == nullptr ? nullptr : child_of(*framework, "experiment");
  if (experiment == nullptr) return;
  set_attribute(*experiment, "random_seed", std::to_string(seed));
}

}  // namespace

void add_implied_hooks(Scenario& scenario, hal::PluginLoader& loader) {
  for (const HookType* type : loader.catalog().all<HookType>()) {
    const auto same = [&](const HookConfig& hook) {
      return hook.library == hal::Catalog::kInside && hook.label == type->name;
    };
    const auto wants_it = [&](const ControllerConfig& config) {
      const auto controller = loader.get<hal::ControllerType>(config.library, config.label);
      return controller.ok() && type->comes_with(*controller.value());
    };
    if (type->comes_with == nullptr || std::ranges::none_of(scenario.controllers, wants_it) ||
        std::ranges::any_of(scenario.hooks, same))
      continue;
    HookConfig& config = scenario.hooks.emplace_back();
    config.library = hal::Catalog::kInside;
    config.label = config.options.name = type->name;
    config.options.file = scenario.file;
  }
}

void complete_settings(Scenario& scenario, hal::PluginLoader& loader, std::uint64_t seed) {
  complete_controllers(scenario, loader);
  put_params_of_robots(scenario);
  complete_engines(scenario, loader.catalog());
  complete_hooks(scenario, loader);
  put_seed(scenario, seed);
}

}  // namespace tandem::core
