#include <algorithm>
#include <cmath>

#include "bench/bench.hpp"
#include "hal/library_folder.hpp"

namespace tandem::bench {
namespace {

constexpr double kArena_m = 40.0;
constexpr double kUsualRobots = 10'000.0;  // what "equal density" refers to
constexpr double kWall_m = 0.1;

/// Outer walls, and inner ones at +-7 m that make 3 x 3 rooms with doors between; all but the walls' thickness times
/// `scale`.
void add_walls(core::Scenario& scenario, double scale) {
  auto& objects = scenario.objects;
  const auto add = [&](double x_m, double y_m, double size_x_m, double size_y_m) {
    core::ObjectItem item;
    item.id = "wall" + std::to_string(objects.size());
    item.size = {size_x_m, size_y_m, 0.5};
    item.placement.p_W = {x_m, y_m, 0.0};
    objects.push_back(item);
  };
  const double half = 0.5 * kArena_m * scale;
  for (const double side : {-1.0, 1.0}) {
    add(side * half, 0.0, kWall_m, 2.0 * half + kWall_m);
    add(0.0, side * half, 2.0 * half + kWall_m, kWall_m);
  }
  constexpr double kParts[4][2] = {{-20.0, -15.0}, {-12.0, -1.5}, {1.5, 12.0}, {15.0, 20.0}};
  for (const double line : {-7.0, 7.0}) {
    for (const auto& part : kParts) {
      const double middle = 0.5 * (part[0] + part[1]) * scale;
      const double length = (part[1] - part[0]) * scale;
      add(line * scale, middle, kWall_m, length);
      add(middle, line * scale, length, kWall_m);
    }
  }
}

/// What follows "device:" in the list; "default" where the list does not name it so.
std::string implementation_in(const std::string& devices, const std::string& device) {
  const std::size_t at = devices.find(device + ":");
  if (at == std::string::npos) return "default";
  const std::size_t begin = at + device.size() + 1;
  return devices.substr(begin, devices.find(',', begin) - begin);
}

/// Range-and-bearing and cameras are taken by controllers that are told to, and change nothing of what they do. Under
/// a script, `lua_controller` steps the same robots; as sources for ARGoS have it, a library of the module `argos3`.
core::ControllerConfig diffusion_controller(const BenchCase& c) {
  core::ControllerConfig config;
  const bool footbot = c.robot == "foot-bot";
  config.id = "diffusion";
  config.label = c.bench == "lua" ? "lua_controller" : footbot ? "footbot_diffusion" : "epuck_diffusion";
  config.library =
      c.bench == "argos" ? (hal::library_folder() / "argos3/lib/libargos_diffusion.so").string() : config.label;
  config.actuators.push_back({"differential_steering", "default", {}});
  core::DeviceChoice proximity{"proximity", implementation_in(c.devices, "proximity"), {}};
  if (c.bench == "lua" || c.bench == "argos")
    proximity.options.name = footbot ? "footbot_proximity" : "epuck_proximity";
  if (c.bench == "lua") {
    config.params.name = "params";
    config.params.attributes.push_back({"script", c.script, 0});
  }
  config.sensors.push_back(std::move(proximity));
  const auto add = [&](const char* sensor, const char* actuator, const char* param) {
    if (c.devices.find(sensor) == std::string::npos) return;
    config.sensors.push_back({sensor, "default", {}});
    config.actuators.push_back({actuator, "default", {}});
    config.params.attributes.push_back({param, "true", 0});
  };
  add("range_and_bearing", "range_and_bearing", "talk");
  add("omnidirectional_camera", "leds", "look");
  return config;
}

core::ControllerConfig flocking_controller() {
  core::ControllerConfig config;
  config.id = "flock";
  config.label = config.library = "eyebot_flocking";
  for (const char* name : {"range_and_bearing", "positioning", "flight_state", "clock"})
    config.sensors.push_back({name, "default", {}});
  for (const char* name : {"quadrotor_speed", "flight_task", "range_and_bearing"})
    config.actuators.push_back({name, "default", {}});
  for (const auto& [name, value] : {std::pair{"distance", "2"}, {"lowest", "2"}, {"highest", "25"}})
    config.params.attributes.push_back({name, value, 0});
  return config;
}

core::RobotItem scattered(const BenchCase& c, const char* id, const core::Vec3& min, const core::Vec3& max) {
  core::RobotItem item;
  item.kind = c.robot;
  item.id = id;
  core::Distribute d;
  d.quantity = c.robots;
  d.max_trials = 10'000;
  d.position.method = d.orientation.method = core::Distribution::Method::Uniform;
  d.position.min = min;
  d.position.max = max;
  d.orientation.min[0] = -M_PI;
  d.orientation.max[0] = M_PI;
  item.distribute = d;
  return item;
}

void make_diffusion(core::Scenario& scenario, const BenchCase& c) {
  const double scale = c.density == "equal" ? std::sqrt(static_cast<double>(c.robots) / kUsualRobots) : 1.0;
  scenario.arena_size = {kArena_m * scale + kWall_m, kArena_m * scale + kWall_m, 1.0};
  add_walls(scenario, scale);
  scenario.kinds = c.kinds;
  scenario.controllers.push_back(diffusion_controller(c));
  const double half = 0.5 * kArena_m * scale - std::min(0.2, 0.05 * kArena_m * scale);
  scenario.robots.push_back(scattered(c, c.robot == "foot-bot" ? "fb" : "ep", {-half, -half, 0.0}, {half, half, 0.0}));
}

/// Eye-bots that keep 2 m from one another: on average 14 lie within the 3 m that their messages reach.
void make_flock(core::Scenario& scenario, const BenchCase& c) {
  constexpr double kSpacing_m = 2.0, kPerRobot_m3 = 8.0;
  constexpr double kHall_m = 10.0;  // height of the part of the hall that they start in
  constexpr double kMargin_m = 10.0;
  const double side_m = std::max(kSpacing_m, std::sqrt(static_cast<double>(c.robots) * kPerRobot_m3 / kHall_m));
  scenario.arena_size = {side_m + 2.0 * kMargin_m, side_m + 2.0 * kMargin_m, kHall_m + 2.0 * kMargin_m};
  scenario.arena_center = {0.0, 0.0, 0.5 * scenario.arena_size[2]};
  scenario.controllers.push_back(flocking_controller());
  scenario.robots.push_back(
      scattered(c, "eb", {-0.5 * side_m, -0.5 * side_m, kMargin_m}, {0.5 * side_m, 0.5 * side_m, kMargin_m + kHall_m}));
}

}  // namespace

core::Scenario scene_of(const BenchCase& c) {
  core::Scenario scenario;
  c.bench == "flocking" ? make_flock(scenario, c) : make_diffusion(scenario, c);
  scenario.file = "bench " + c.bench;
  scenario.name = c.bench;
  scenario.seed = 1;
  scenario.ticks_per_second = 10;
  scenario.threads = c.threads;
  scenario.assignment = c.dynamic ? core::Assignment::Dynamic : core::Assignment::Static;
  core::EngineConfig engine;
  engine.kind = engine.id = c.engine;
  engine.regions = c.partition.regions;
  scenario.engines.push_back(engine);
  return scenario;
}

}  // namespace tandem::bench
