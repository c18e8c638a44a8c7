// Foot-bots whose commands the test writes, for tests of the world.
#pragma once
#include <string>

#include "core/space/stores.hpp"
#include "hal/device/distance_scanner.hpp"
#include "hal/device/gripper.hpp"
#include "hal/device/turret.hpp"
#include "hal/device/wheels.hpp"
#include "hal/robot/footbot.hpp"
#include "tests/core/scenes.hpp"

namespace tandem::core {

/// An arena of `size_m` squared with one engine and no robots; the configuration added last lists every device of a
/// foot-bot.
inline Scene footbot_scene(const std::string& engine = "dynamics2d", double size_m = 4.0,
                           const std::string& controller = "puppet") {
  Scene scene(size_m, controller);
  ControllerConfig& config = scene.scenario.controllers.back();
  config.sensors.clear();
  config.actuators.clear();
  for (const char* name :
       {"proximity", "light", "base_ground", "motor_ground", "wheel_encoders", "odometry", "accelerometer", "gyroscope",
        "battery", "clock", "range_and_bearing", "positioning", "turret_encoder", "gripper", "distance_scanner"})
    config.sensors.push_back({name, "default", {}});
  for (const char* name :
       {"differential_steering", "leds", "range_and_bearing", "turret", "gripper", "distance_scanner"})
    config.actuators.push_back({name, "default", {}});
  scene.engine(engine);
  return scene;
}

inline void add_footbot(Scene& scene, const std::string& id, double x_m, double y_m, double heading_rad = 0.0) {
  scene.robot(id, x_m, y_m, heading_rad);
  scene.scenario.robots.back().kind = "foot-bot";
}

/// Sets the implementation of one device, with its options.
inline void choose(Scene& scene, const std::string& device, hal::Role role, const std::string& implementation,
                   const std::vector<Element::Attribute>& options = {}) {
  ControllerConfig& config = scene.scenario.controllers.back();
  for (DeviceChoice& choice : role == hal::Role::Sensor ? config.sensors : config.actuators) {
    if (choice.device != device) continue;
    choice.implementation = implementation;
    choice.options.name = device;
    choice.options.file = "scene";
    choice.options.line = 11;
    choice.options.attributes = options;
  }
}

template <class Port>
const Port& reading(const MadeWorld& world, const std::string& id) {
  const Space& space = world.world->space();
  return *space.port<Port>(space.find_robot(id));
}

template <class Port>
Port& command(const MadeWorld& world, const std::string& id) {
  Space& space = world.world->space();
  return *space.port<Port>(space.find_robot(id));
}

inline Pose pose_of(const MadeWorld& world, const std::string& id) {
  const Space& space = world.world->space();
  return space.pose(space.find_robot(id));
}

inline void steps(const MadeWorld& world, int count) {
  for (int i = 0; i < count; ++i) world.world->step();
}

}  // namespace tandem::core
