// Shared by the tests of the reader: texts in, scenario and problems out.
#pragma once
#include <gtest/gtest.h>
#include <optional>
#include <string>
#include <vector>

#include "core/config/reader.hpp"

namespace tandem::core {

inline const KnownNames& known_names() {
  static const KnownNames names = {
      {"e-puck", "foot-bot", "eye-bot"},
      {{"kinematics2d", "", {}},
       {"dynamics2d", "", {.forces = true}},
       {"dynamics3d", "", {.plane = false, .forces = true}},
       {"particle3d", "pointmass3d", {.plane = false, .air = true}}},
      {"accelerometer", "altimeter", "battery", "clock", "flight_state", "gripper", "ground", "light", "microphones",
       "motor_ground", "odometry", "omnidirectional_camera", "pan_tilt_encoder", "positioning", "proximity",
       "range_and_bearing", "wheel_encoders"},
      {"body_led", "camera_led", "differential_steering", "flight_task", "front_led", "gripper", "leds", "pan_tilt",
       "quadrotor_attitude", "quadrotor_position", "quadrotor_speed", "range_and_bearing", "turret", "upper_leds"}};
  return names;
}

struct Outcome {
  std::optional<Scenario> scenario;
  Problems problems;

  std::string text() const {
    std::string all;
    for (const Problem& p : problems) all += to_text(p) + "\n";
    return all;
  }
  const Scenario& good() const {
    EXPECT_TRUE(scenario.has_value()) << text();
    static const Scenario none;
    return scenario ? *scenario : none;
  }
};

inline Outcome read(const std::string& text, const std::vector<std::string>& overrides = {},
                    const KnownNames& known = known_names()) {
  Outcome out;
  out.scenario = read_experiment_text(text, "file.xml", overrides, known, out.problems);
  return out;
}

/// A correct experiment in which parts can be replaced. Every part stands on the line of its name.
struct Parts {
  std::string framework =
      R"(<framework><experiment length="10" ticks_per_second="10" random_seed="1"/></framework>)";  // line 2
  std::string controllers =
      R"(<controllers><wander id="w" library="wander"><sensors><proximity/></sensors></wander></controllers>)";  // 3
  std::string engines = R"(<physics_engines><kinematics2d id="k"/></physics_engines>)";                          // 4
  std::string arena = R"(<arena size="4,4,1">)";                                                                 // 5
  std::string things = R"(<e-puck id="ep"><body position="0,0,0"/><controller config="w"/></e-puck>)";           // 6
  std::string rest;                                                                                              // 8

  std::string text() const {
    return "<tandem>\n" + framework + "\n" + controllers + "\n" + engines + "\n" + arena + "\n" + things +
           "\n</arena>\n" + rest + "\n</tandem>\n";
  }
};

}  // namespace tandem::core
