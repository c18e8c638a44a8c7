#include "bench/scene.hpp"

#include <algorithm>
#include <cmath>

namespace tandem::bench {
namespace {

constexpr double kArena_m = 40.0;
constexpr double kUsualRobots = 10'000.0;  // what "equal density" refers to
constexpr double kWall_m = 0.1;

core::ObjectItem wall(double x_m, double y_m, double size_x_m, double size_y_m, std::size_t number) {
  core::ObjectItem item;
  item.id = "wall" + std::to_string(number);
  item.size = {size_x_m, size_y_m, 0.5};
  item.placement.p_W = {x_m, y_m, 0.0};
  return item;
}

/// Outer walls, and inner ones at +-7 m that make 3 x 3 rooms with doors between; all but the walls' thickness times
/// `scale`.
void add_walls(core::Scenario& scenario, double scale) {
  auto& objects = scenario.objects;
  const double half = 0.5 * kArena_m * scale;
  for (const double side : {-1.0, 1.0}) {
    objects.push_back(wall(side * half, 0.0, kWall_m, 2.0 * half + kWall_m, objects.size()));
    objects.push_back(wall(0.0, side * half, 2.0 * half + kWall_m, kWall_m, objects.size()));
  }
  constexpr double kParts[4][2] = {{-20.0, -15.0}, {-12.0, -1.5}, {1.5, 12.0}, {15.0, 20.0}};
  for (const double line : {-7.0, 7.0}) {
    for (const auto& part : kParts) {
      const double middle = 0.5 * (part[0] + part[1]) * scale;
      const double length = (part[1] - part[0]) * scale;
      objects.push_back(wall(line * scale, middle, kWall_m, length, objects.size()));
      objects.push_back(wall(middle, line * scale, length, kWall_m, objects.size()));
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

/// Range-and-bearing and cameras are taken by controllers that are told to, and change nothing of what they do.
core::ControllerConfig diffusion_controller(const std::string& robot, const std::string& devices) {
  core::ControllerConfig config;
  config.id = "diffusion";
  config.label = robot == "foot-bot" ? "footbot_diffusion" : "epuck_diffusion";
  config.library = config.label;
  config.sensors.push_back({"proximity", implementation_in(devices, "proximity"), {}});
  config.actuators.push_back({"differential_steering", "default", {}});
  if (devices.find("range_and_bearing") != std::string::npos) {
    config.sensors.push_back({"range_and_bearing", "default", {}});
    config.actuators.push_back({"range_and_bearing", "default", {}});
    config.params.attributes.push_back({"talk", "true", 0});
  }
  if (devices.find("omnidirectional_camera") != std::string::npos) {
    config.sensors.push_back({"omnidirectional_camera", "default", {}});
    config.actuators.push_back({"leds", "default", {}});
    config.params.attributes.push_back({"look", "true", 0});
  }
  return config;
}

/// The same robots under a script, which the caller has written to the file.
core::ControllerConfig scripted_controller(const std::string& robot, const std::string& script) {
  core::ControllerConfig config;
  config.id = "diffusion";
  config.label = config.library = "lua_controller";
  core::Element written;
  written.name = robot == "foot-bot" ? "footbot_proximity" : "epuck_proximity";
  config.sensors.push_back({"proximity", "default", written});
  config.actuators.push_back({"differential_steering", "default", {}});
  config.params.name = "params";
  config.params.attributes.push_back({"script", script, 0});
  return config;
}

core::RobotItem scattered_robots(const BenchCase& c, double scale) {
  core::RobotItem item;
  item.kind = c.robot;
  item.id = c.robot == "foot-bot" ? "fb" : "ep";
  core::Distribute d;
  d.quantity = c.robots;
  d.max_trials = 10'000;
  d.position.method = core::Distribution::Method::Uniform;
  const double half = 0.5 * kArena_m * scale - std::min(0.2, 0.05 * kArena_m * scale);
  d.position.min = {-half, -half, 0.0};
  d.position.max = {half, half, 0.0};
  d.orientation.method = core::Distribution::Method::Uniform;
  d.orientation.min = {-M_PI, 0.0, 0.0};
  d.orientation.max = {M_PI, 0.0, 0.0};
  item.distribute = d;
  return item;
}

core::Scenario diffusion_scene(const BenchCase& c) {
  core::Scenario scenario;
  const double scale = c.density == "equal" ? std::sqrt(static_cast<double>(c.robots) / kUsualRobots) : 1.0;
  scenario.arena_size = {kArena_m * scale + kWall_m, kArena_m * scale + kWall_m, 1.0};
  add_walls(scenario, scale);

  scenario.kinds = c.kinds;
  scenario.controllers.push_back(c.bench == "lua" ? scripted_controller(c.robot, c.script)
                                                  : diffusion_controller(c.robot, c.devices));
  scenario.robots.push_back(scattered_robots(c, scale));
  return scenario;
}

// Eye-bots that keep 2 m from one another: on average 14 lie within the 3 m that their messages reach.
constexpr double kSpacing_m = 2.0;
constexpr double kPerRobot_m3 = 8.0;
constexpr double kHall_m = 10.0;  // height of the part of the hall that they start in
constexpr double kMargin_m = 10.0;

core::Scenario flocking_scene(const BenchCase& c) {
  core::Scenario scenario;
  const double side_m = std::max(kSpacing_m, std::sqrt(static_cast<double>(c.robots) * kPerRobot_m3 / kHall_m));
  scenario.arena_size = {side_m + 2.0 * kMargin_m, side_m + 2.0 * kMargin_m, kHall_m + 2.0 * kMargin_m};
  scenario.arena_center = {0.0, 0.0, 0.5 * scenario.arena_size[2]};
  core::ControllerConfig config;
  config.id = "flock";
  config.label = config.library = "eyebot_flocking";
  for (const char* name : {"range_and_bearing", "positioning", "flight_state", "clock"})
    config.sensors.push_back({name, "default", {}});
  for (const char* name : {"quadrotor_speed", "flight_task", "range_and_bearing"})
    config.actuators.push_back({name, "default", {}});
  for (const auto& [name, value] : {std::pair{"distance", "2"}, {"lowest", "2"}, {"highest", "25"}})
    config.params.attributes.push_back({name, value, 0});
  scenario.controllers.push_back(config);

  core::RobotItem item;
  item.kind = c.robot;
  item.id = "eb";
  core::Distribute d;
  d.quantity = c.robots;
  d.max_trials = 10'000;
  d.position.method = core::Distribution::Method::Uniform;
  d.position.min = {-0.5 * side_m, -0.5 * side_m, kMargin_m};
  d.position.max = {0.5 * side_m, 0.5 * side_m, kMargin_m + kHall_m};
  d.orientation.method = core::Distribution::Method::Uniform;
  d.orientation.min = {-M_PI, 0.0, 0.0};
  d.orientation.max = {M_PI, 0.0, 0.0};
  item.distribute = d;
  scenario.robots.push_back(item);
  return scenario;
}

}  // namespace

core::Scenario scene_of(const BenchCase& c) {
  core::Scenario scenario = c.bench == "flocking" ? flocking_scene(c) : diffusion_scene(c);
  scenario.file = "bench " + c.bench;
  scenario.name = c.bench;
  scenario.seed = 1;
  scenario.ticks_per_second = 10;
  scenario.threads = c.threads;
  scenario.assignment = c.assignment;
  core::EngineConfig engine;
  engine.kind = c.engine;
  engine.id = c.engine;
  engine.regions = c.regions;
  scenario.engines.push_back(engine);
  return scenario;
}

}  // namespace tandem::bench
