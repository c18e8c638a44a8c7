// Eye-bots whose commands the test writes, for tests of the world.
#pragma once
#include <string>

#include "hal/device/flight.hpp"
#include "hal/device/pan_tilt.hpp"
#include "hal/robot/eyebot.hpp"
#include "tests/core/footbots.hpp"

namespace tandem::core {

/// One more configuration, which lists every device of an eye-bot.
inline void add_eyebot_kit(Scene& scene) {
  ControllerConfig config;
  config.id = "eye" + std::to_string(scene.scenario.controllers.size());
  config.label = "eye_puppet";
  config.library = "test_controllers";
  for (const char* name :
       {"flight_state", "altimeter", "positioning", "pan_tilt_encoder", "perspective_camera", "distance_scanner",
        "range_and_bearing", "proximity", "light", "battery", "accelerometer", "gyroscope", "clock"})
    config.sensors.push_back({name, "default", {}});
  for (const char* name : {"quadrotor_position", "quadrotor_speed", "quadrotor_attitude", "flight_task", "leds",
                           "upper_leds", "camera_led", "pan_tilt", "distance_scanner", "range_and_bearing"})
    config.actuators.push_back({name, "default", {}});
  scene.scenario.controllers.push_back(config);
}

/// A hall of `size_m` squared and 3 m high with one engine; the configuration added last is that of eye-bots. 50 steps
/// a second.
inline Scene eyebot_scene(const std::string& way = "particle3d", double size_m = 8.0) {
  Scene scene(size_m);
  scene.scenario.arena_size[2] = 3.0;
  scene.scenario.arena_center[2] = 1.5;
  scene.scenario.ticks_per_second = 50;
  add_engine(scene, way);
  add_eyebot_kit(scene);
  return scene;
}

}  // namespace tandem::core
