// Scenarios built inline, for tests of the world.
#pragma once
#include <array>
#include <map>
#include <memory>
#include <string>
#include <utility>
#include <vector>

#include "core/sim/world.hpp"
#include "tests/checkout.hpp"
#include "tests/core/catalog.hpp"

namespace tandem::core {

/// An arena of `size_m` squared with one controller configuration.
struct Scene {
  Scenario scenario;

  explicit Scene(double size_m = 4.0, const std::string& controller = "drive",
                 const std::string& library = "test_controllers") {
    scenario.file = "scene";
    scenario.name = "scene";
    scenario.seed = 7;
    scenario.ticks_per_second = 10;
    scenario.arena_size = {size_m, size_m, 1.0};
    ControllerConfig config;
    config.id = "c";
    config.label = controller;
    config.library = library;
    for (const char* name : {"proximity", "light", "ground", "wheel_encoders", "accelerometer", "microphones",
                             "battery", "clock", "range_and_bearing"}) {
      config.sensors.push_back({name, "default", {}});
    }
    for (const char* name : {"differential_steering", "leds", "body_led", "front_led", "range_and_bearing"}) {
      config.actuators.push_back({name, "default", {}});
    }
    config.actuators.front().implementation = "ideal";  // wheels that turn exactly as told, not as stepper motors do
    scenario.controllers.push_back(config);
  }

  Scene& param(const std::string& name, const std::string& value) {
    scenario.controllers.back().params.attributes.push_back({name, value, 0});
    return *this;
  }
  /// Of all devices but the lamps, which have nothing to err in.
  Scene& implementations(const std::string& name) {
    for (auto* list : {&scenario.controllers.back().sensors, &scenario.controllers.back().actuators}) {
      for (DeviceChoice& choice : *list) {
        if (choice.device != "leds" && !choice.device.ends_with("_led")) choice.implementation = name;
      }
    }
    return *this;
  }
  Scene& robot(const std::string& id, double x_m, double y_m, double heading_rad = 0.0) {
    RobotItem item;
    item.kind = "e-puck";
    item.id = id;
    item.placement = {{x_m, y_m, 0.0}, heading_rad, 0.0, 0.0};
    scenario.robots.push_back(item);
    return *this;
  }
  /// One more controller configuration, of robots that fly; it is theirs from now on.
  Scene& pilot(const std::string& controller, const std::vector<Element::Attribute>& params = {},
               const std::string& implementation = "default") {
    ControllerConfig config;
    config.id = "pilot" + std::to_string(scenario.controllers.size());
    config.label = controller;
    config.library = "test_controllers";
    config.params.attributes = params;
    for (const char* name : {"proximity", "light", "battery", "range_and_bearing", "positioning"})
      config.sensors.push_back({name, implementation, {}});
    for (const char* name : {"quadrotor_position", "quadrotor_speed", "range_and_bearing"})
      config.actuators.push_back({name, implementation, {}});
    scenario.controllers.push_back(config);
    return *this;
  }
  /// An eye-bot with the configuration added last.
  Scene& flyer(const std::string& id, double x_m, double y_m, double z_m, double heading_rad = 0.0) {
    RobotItem item;
    item.kind = "eye-bot";
    item.id = id;
    item.controller = scenario.controllers.size() - 1;
    item.placement = {{x_m, y_m, z_m}, heading_rad, 0.0, 0.0};
    scenario.robots.push_back(item);
    return *this;
  }
  /// What the flying robot added last flies with, in W, instead of its pilot's own; of the controller "fly".
  Scene& velocity(const std::array<double, 3>& v_m_s, double turn_rad_s = 0.0) {
    Element params;
    params.name = "params";
    params.attributes = {
        {"velocity",
         hal::format_number(v_m_s[0]) + "," + hal::format_number(v_m_s[1]) + "," + hal::format_number(v_m_s[2]), 0},
        {"turn", hal::format_number(turn_rad_s), 0}};
    scenario.robots.back().params = params;
    return *this;
  }
  /// Wheel speeds of the robot added last, instead of its controller configuration's.
  Scene& wheels(double left_m_s, double right_m_s) {
    Element params;
    params.name = "params";
    params.attributes = {{"left", hal::format_number(left_m_s), 0}, {"right", hal::format_number(right_m_s), 0}};
    scenario.robots.back().params = params;
    return *this;
  }
  Scene& robots(std::int64_t quantity, double half_m) {
    RobotItem item;
    item.kind = "e-puck";
    item.id = "ep";
    Distribute d;
    d.quantity = quantity;
    d.max_trials = 1000;
    d.position.method = Distribution::Method::Uniform;
    d.position.min = {-half_m, -half_m, 0.0};
    d.position.max = {half_m, half_m, 0.0};
    d.orientation.method = Distribution::Method::Uniform;
    d.orientation.min = {-3.14159, 0.0, 0.0};
    d.orientation.max = {3.14159, 0.0, 0.0};
    item.distribute = d;
    scenario.robots.push_back(item);
    return *this;
  }
  Scene& box(double x_m, double y_m, double size_x_m, double size_y_m, double heading_rad = 0.0,
             double height_m = 0.5) {
    ObjectItem item;
    item.id = "box" + std::to_string(scenario.objects.size());
    item.size = {size_x_m, size_y_m, height_m};
    item.placement = {{x_m, y_m, 0.0}, heading_rad, 0.0, 0.0};
    scenario.objects.push_back(item);
    return *this;
  }
  Scene& cylinder(double x_m, double y_m, double radius_m) {
    ObjectItem item;
    item.shape = ShapeKind::Cylinder;
    item.id = "cylinder" + std::to_string(scenario.objects.size());
    item.size = {radius_m, radius_m, 0.5};
    item.placement.p_W = {x_m, y_m, 0.0};
    scenario.objects.push_back(item);
    return *this;
  }
  /// Changes the parts of all robots that are there, alike for those of one kind.
  template <class Change>
  Scene& parts(Change&& change) {
    std::map<std::string, std::shared_ptr<const hal::RobotKind>> own;
    for (RobotItem& robot : scenario.robots) {
      auto& kind = own[robot.kind];
      if (kind == nullptr) {
        const auto made = std::make_shared<hal::RobotKind>(*test::catalog().find<hal::RobotKind>(robot.kind));
        change(*made);
        kind = made;
      }
      robot.own_kind = kind;
    }
    return *this;
  }
  /// Makes the object added last a movable one.
  Scene& movable(double mass_kg) {
    scenario.objects.back().movable = true;
    scenario.objects.back().mass_kg = mass_kg;
    return *this;
  }
  /// One more engine; `id` is its kind where it is empty.
  Scene& engine(const std::string& kind, const std::string& id = "", const std::vector<Element::Attribute>& more = {}) {
    EngineConfig config;
    config.kind = kind;
    config.id = id.empty() ? kind : id;
    config.line = 100 + static_cast<int>(scenario.engines.size());
    config.options.name = kind;
    config.options.file = scenario.file;
    config.options.line = config.line;
    config.options.attributes = {{"id", config.id, config.line}};
    config.options.attributes.insert(config.options.attributes.end(), more.begin(), more.end());
    scenario.engines.push_back(config);
    return *this;
  }
  /// Splits the region of the engine added last: "4x4" or "auto".
  Scene& split(const std::string& regions) {
    scenario.engines.back().regions = regions;
    scenario.engines.back().options.attributes.push_back({"regions", regions, scenario.engines.back().line});
    return *this;
  }
  /// One more vertex of the region of the engine added last; the side that starts there leads to engine `gate`, or is a
  /// wall.
  Scene& side(double x_m, double y_m, const std::string& gate = "") {
    scenario.engines.back().sides.push_back({x_m, y_m, gate, scenario.engines.back().line});
    return *this;
  }
  /// What the file says of a field, on line 5.
  Scene& field(const std::string& name, const std::vector<Element::Attribute>& attributes) {
    scenario.fields.push_back({name, scenario.file, 5, attributes, {}});
    return *this;
  }
  /// Walls 10 cm thick around the arena, inside it.
  Scene& walls() {
    const double s = scenario.arena_size[0];
    return box(0, 0.5 * s - 0.05, s, 0.1)
        .box(0, -0.5 * s + 0.05, s, 0.1)
        .box(0.5 * s - 0.05, 0, 0.1, s)
        .box(-0.5 * s + 0.05, 0, 0.1, s);
  }
};

/// A hook of the tests' own library.
inline Scene& with_hook(Scene& scene, const std::string& label, std::vector<Element::Attribute> params = {}) {
  HookConfig hook;
  hook.library = "test_hooks";
  hook.label = label;
  hook.options.name = "loop_functions";
  hook.options.attributes = std::move(params);
  scene.scenario.hooks.push_back(std::move(hook));
  return scene;
}

/// Every way in which an engine flies robots: its kind, and where it has several its `flight`.
inline std::vector<std::string> ways_to_fly() {
  return {"particle3d", "particle3d_exact", "dynamics3d", "dynamics3d_rotors"};
}

/// Adds the engine of a way to fly.
inline Scene& add_engine(Scene& scene, const std::string& way, const std::string& id = "") {
  const std::size_t at = way.find('_');
  if (at == std::string::npos) return scene.engine(way, id);
  return scene.engine(way.substr(0, at), id, {{"flight", way.substr(at + 1), 100}});
}

/// A world and the loader that must outlive it.
struct MadeWorld {
  std::unique_ptr<hal::PluginLoader> loader;
  std::unique_ptr<World> world;
  Problems problems;

  World* operator->() const { return world.get(); }
  std::string all_problems() const {
    std::string text;
    for (const Problem& p : problems) text += to_text(p) + "\n";
    return text;
  }
};

inline MadeWorld make(const Scene& scene, const WorldOptions& options = {},
                      const hal::Catalog& catalog = test::catalog()) {
  MadeWorld made;
  made.loader = std::make_unique<hal::PluginLoader>(
      std::vector<std::filesystem::path>{std::string(test::kBuildDir) + "/lib"}, catalog);
  made.world = World::make(scene.scenario, *made.loader, options, made.problems);
  return made;
}

inline void run(World& world, int steps) {
  world.start();
  for (int i = 0; i < steps; ++i) world.step();
  world.finish();
}

}  // namespace tandem::core
