// Robots that shine and look, for tests of cameras.
#pragma once
#include <string>

#include "hal/device/cameras.hpp"
#include "tests/core/footbots.hpp"

namespace tandem::core {

/// An arena of `size_m` squared and 4 m high, without robots; its configurations are 0 of foot-bots, 1 of e-pucks, 2 of
/// eye-bots.
inline Scene camera_scene(double size_m = 6.0) {
  Scene scene(size_m, "watcher");
  scene.scenario.arena_size[2] = 4.0;
  scene.scenario.arena_center[2] = 2.0;
  ControllerConfig& config = scene.scenario.controllers.front();
  const auto list = [](std::vector<DeviceChoice>& choices, std::initializer_list<const char*> names) {
    choices.clear();
    for (const char* name : names) choices.push_back({name, "default", {}});
  };
  list(config.sensors, {"omnidirectional_camera", "perspective_camera"});
  list(config.actuators, {"differential_steering", "leds", "turret"});
  ControllerConfig small = config;
  small.id = "small";
  list(small.sensors, {});
  list(small.actuators, {"differential_steering", "leds", "body_led", "front_led"});
  ControllerConfig high = config;
  high.id = "high";
  list(high.sensors, {"perspective_camera"});
  list(high.actuators, {"quadrotor_speed", "leds"});
  scene.scenario.controllers.push_back(small);
  scene.scenario.controllers.push_back(high);
  scene.engine("kinematics2d");
  return scene;
}

/// Sets the implementation of a device in all configurations.
inline void choose_everywhere(Scene& scene, const std::string& device, const std::string& implementation,
                              const std::vector<Element::Attribute>& options = {}) {
  for (ControllerConfig& config : scene.scenario.controllers) {
    for (auto* list : {&config.sensors, &config.actuators}) {
      for (DeviceChoice& choice : *list) {
        if (choice.device != device) continue;
        choice.implementation = implementation;
        choice.options.name = device;
        choice.options.file = "scene";
        choice.options.line = 11;
        choice.options.attributes = options;
      }
    }
  }
}

/// Hangs an LED on the object added last.
inline void add_led(Scene& scene, const Vec3& p_O, const std::array<std::uint8_t, 3>& rgb,
                    const std::string& medium = "") {
  scene.scenario.objects.back().leds.push_back({p_O, rgb});
  scene.scenario.objects.back().led_medium = medium;
}

inline void shine(const MadeWorld& world, const std::string& id, hal::Rgb color) {
  command<hal::RingLeds>(world, id).set_all(color);
}

}  // namespace tandem::core
