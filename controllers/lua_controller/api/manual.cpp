#include "controllers/lua_controller/api/manual.hpp"

#include <array>

namespace tandem::controllers::lua {
namespace {

constexpr hal::Role kSensor = hal::Role::Sensor;
constexpr hal::Role kActuator = hal::Role::Actuator;

// clang-format off
constexpr std::array kNames = std::to_array<ApiName>({
  {"", kSensor, "robot.id", "", "the robot's id"},
  {"", kSensor, "robot.params", "", "attributes of <params>, as texts"},
  {"", kSensor, "robot.random.uniform", "([[low,] high])", "in [low, high), [0, high) or [0, 1)"},
  {"", kSensor, "robot.random.uniform_int", "([low,] high)", "a whole number in [low, high) or [0, high)"},
  {"", kSensor, "robot.random.bernoulli", "([p])", "1 with probability p, 0.5 unless said, else 0"},
  {"", kSensor, "robot.random.gaussian", "(deviation [, mean])", "of the normal distribution"},
  {"", kSensor, "robot.random.exponential", "(mean)", "of the exponential distribution"},
  {"", kSensor, "robot.random.poisson", "(mean)", "of the Poisson distribution"},
  {"", kSensor, "robot.sensors", "", "every sensor by its own fields, see below"},
  {"", kSensor, "robot.actuators", "", "every actuator by its own fields, see below"},
  {"", kSensor, "log", "(…)", "writes its arguments to the run's log"},
  {"", kSensor, "logerr", "(…)", "the same, as an error"},
  {"", kSensor, "vector2", "([x, y])", "+ - * == length() dot(v) cross(v) normalize() rotate(angle) angle()"},
  {"", kSensor, "vector3", "([x, y, z])", "+ - * == length() dot(v) cross(v) normalize() rotate(quaternion)"},
  {"", kSensor, "quaternion", "([w, x, y, z] | [angle, axis])", "* == normalize() inverse() toangleaxis() toeulerangles()"},
  {"differential_steering", kActuator, "robot.wheels.set_velocity", "(left, right)", "cm/s"},
  {"wheel_encoders", kSensor, "robot.wheels.distance_left", "", "cm rolled in the last tick"},
  {"wheel_encoders", kSensor, "robot.wheels.distance_right", "", "cm rolled in the last tick"},
  {"wheel_encoders", kSensor, "robot.wheels.velocity_left", "", "cm/s"},
  {"wheel_encoders", kSensor, "robot.wheels.velocity_right", "", "cm/s"},
  {"wheel_encoders", kSensor, "robot.wheels.axis_length", "", "cm between the wheels"},
  {"proximity", kSensor, "robot.proximity", "", "[i].value 0 to 1, [i].angle; plain numbers where the file says <proximity/>"},
  {"light", kSensor, "robot.light", "", "[i].value 0 to 1, [i].angle; plain numbers where the file says <light/>"},
  {"ground", kSensor, "robot.ground", "", "[i]: 0 black to 1 white"},
  {"base_ground", kSensor, "robot.base_ground", "", "[i].value 0 black to 1 white, [i].offset in cm"},
  {"motor_ground", kSensor, "robot.motor_ground", "", "[i].value 0 black to 1 white, [i].offset in cm"},
  {"range_and_bearing", kSensor, "robot.range_and_bearing", "", "[i].range in cm, .horizontal_bearing, .vertical_bearing, .data[j]"},
  {"range_and_bearing", kActuator, "robot.range_and_bearing.set_data", "(i, byte) or (bytes)", "what is broadcast in every step"},
  {"range_and_bearing", kActuator, "robot.range_and_bearing.clear_data", "()", "all bytes 0"},
  {"leds", kActuator, "robot.leds.set_single_color", "(i, \"red\") or (i, r, g, b)", "of one LED"},
  {"leds", kActuator, "robot.leds.set_all_colors", "(\"red\") or (r, g, b)", "of all LEDs"},
  {"upper_leds", kActuator, "robot.upper_leds.set_single_color", "(i, \"red\") or (i, r, g, b)", "of one LED"},
  {"upper_leds", kActuator, "robot.upper_leds.set_all_colors", "(\"red\") or (r, g, b)", "of all LEDs"},
  {"omnidirectional_camera", kSensor, "robot.colored_blob_omnidirectional_camera", "", "[i].distance in cm, .angle, .color.red/green/blue"},
  {"omnidirectional_camera", kSensor, "robot.colored_blob_omnidirectional_camera.enable", "()", "off at the start"},
  {"omnidirectional_camera", kSensor, "robot.colored_blob_omnidirectional_camera.disable", "()", ""},
  {"perspective_camera", kSensor, "robot.colored_blob_perspective_camera", "", "[i].x, .y in pixels, .color.red/green/blue"},
  {"perspective_camera", kSensor, "robot.colored_blob_perspective_camera.enable", "()", "off at the start"},
  {"perspective_camera", kSensor, "robot.colored_blob_perspective_camera.disable", "()", ""},
  {"distance_scanner", kActuator, "robot.distance_scanner.enable", "()", "measures, standing"},
  {"distance_scanner", kActuator, "robot.distance_scanner.disable", "()", ""},
  {"distance_scanner", kActuator, "robot.distance_scanner.set_angle", "(radians)", ""},
  {"distance_scanner", kActuator, "robot.distance_scanner.set_rpm", "(rpm)", "turns"},
  {"distance_scanner", kSensor, "robot.distance_scanner.short_range", "", "[i].angle, .distance in cm; -1 too near, -2 nothing"},
  {"distance_scanner", kSensor, "robot.distance_scanner.long_range", "", "the same of the far heads"},
  {"turret", kActuator, "robot.turret.set_rotation", "(radians)", ""},
  {"turret", kActuator, "robot.turret.set_rotation_speed", "(radians per second)", ""},
  {"turret", kActuator, "robot.turret.set_position_control_mode", "()", ""},
  {"turret", kActuator, "robot.turret.set_speed_control_mode", "()", ""},
  {"turret", kActuator, "robot.turret.set_passive_mode", "()", ""},
  {"turret_encoder", kSensor, "robot.turret.rotation", "", "radians"},
  {"gripper", kActuator, "robot.gripper.lock", "()", "also lock_positive, lock_negative"},
  {"gripper", kActuator, "robot.gripper.unlock", "()", ""},
  {"quadrotor_position", kActuator, "robot.quadrotor.set_absolute_position", "(x, y, z)", "m"},
  {"quadrotor_position", kActuator, "robot.quadrotor.set_relative_position", "(x, y, z)", "m; needs the sensor positioning"},
  {"quadrotor_position", kActuator, "robot.quadrotor.set_absolute_yaw", "(degrees)", ""},
  {"quadrotor_position", kActuator, "robot.quadrotor.set_relative_yaw", "(degrees)", "needs the sensor positioning"},
  {"quadrotor_speed", kActuator, "robot.quadrotor.set_linear_velocity", "(x, y [, z])", "m/s"},
  {"quadrotor_speed", kActuator, "robot.quadrotor.set_rotational_speed", "(radians per second)", ""},
  {"pan_tilt", kActuator, "robot.pan_tilt_camera.set_pan", "(radians)", ""},
  {"pan_tilt", kActuator, "robot.pan_tilt_camera.set_tilt", "(radians)", ""},
  {"positioning", kSensor, "robot.positioning.position", "", "a vector3, m"},
  {"positioning", kSensor, "robot.positioning.orientation", "", "a quaternion, with its .angle and .axis"},
  {"battery", kSensor, "robot.battery.available_charge", "", "0 empty to 1 full"},
  {"battery", kSensor, "robot.battery.time_left", "", "infinite: the robot cannot know"},
});
// clang-format on

std::string padded(std::string text, std::size_t width) {
  while (text.size() < width) text += ' ';
  return text;
}

}  // namespace

std::span<const ApiName> api_names() {
  return kNames;
}

std::string manual(const hal::Catalog& catalog) {
  std::string text =
      "scripts in Lua 5.4: functions step() and, where the script has them, init(), reset(), destroy()\n"
      "ARGoS' names and units:\n";
  for (const ApiName& n : kNames) {
    text += "  " + padded(std::string(n.name) + std::string(n.arguments), 62) + " " + std::string(n.doc);
    if (!n.port.empty())
      text +=
          std::string(n.doc.empty() ? "" : "; ") + (n.role == kSensor ? "sensor " : "actuator ") + std::string(n.port);
    text += "\n";
  }
  text += "every port by its fields, in SI; those of sensors can be read, those of actuators read and set:\n";
  for (const hal::Role role : {kSensor, kActuator}) {
    for (const hal::PortType* port : catalog.all<hal::PortType>()) {
      if (port->role != role) continue;
      text += "  " + std::string(role == kSensor ? "robot.sensors." : "robot.actuators.") + std::string(port->name) +
              ": " + std::string(port->doc) + "\n";
      for (const hal::Field& f : port->fields) {
        text += "    ." + padded(std::string(f.name) + (f.count > 1 ? "[1…" + std::to_string(f.count) + "]" : ""), 18) +
                " " + std::string(f.doc) + (f.unit.symbol.empty() ? "" : " [" + std::string(f.unit.symbol) + "]") +
                "\n";
      }
    }
  }
  return text;
}

}  // namespace tandem::controllers::lua
