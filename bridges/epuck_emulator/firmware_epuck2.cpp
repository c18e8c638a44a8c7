// Binary commands that only the e-puck2's firmware has.
#include <algorithm>

#include "bridges/epuck_emulator/firmware.hpp"
#include "bridges/epuck_emulator/raw_units.hpp"

namespace tandem::bridges::epuck_emulator {
namespace {

// Command bytes are 256 minus these.
enum Command : int {
  kAllSensors = 0x08,
  kAllActuators = 0x09,
  kRgbLeds = 0x0A,
  kButton = 0x0B,
  kMicrophones = 0x0C,
  kTimeOfFlight = 0x0D,
  kMemoryCard = 0x0E,
  kMagnetometer = 0x0F,
  kProximityRate = 0x10,
  kTimeOfFlightSwitch = 0x11
};

int millimetres(double distance_m) {
  return static_cast<int>(std::clamp(distance_m * 1000.0 + 0.5, 0.0, 65535.0));
}

}  // namespace

std::optional<std::size_t> Firmware::epuck2_payload_of(int command) const {
  switch (command) {
    case kAllSensors:
    case kButton:
    case kMicrophones:
    case kTimeOfFlight:
    case kMemoryCard:
      return 0;
    case kAllActuators:
      return 19;
    case kRgbLeds:
      return 12;
    case kMagnetometer:
    case kProximityRate:
    case kTimeOfFlightSwitch:
      return 1;
    default:
      return std::nullopt;
  }
}

void Firmware::obey_epuck2(hal::TimeNs at) {
  const BodySenses senses = body_.sense(at);
  switch (memory_.command) {
    case kAllSensors:
      put_all_sensors(senses);
      break;
    case kAllActuators:
      set_all_actuators(at);
      break;
    case kRgbLeds: {
      BodyCommand lights = memory_.lights;
      std::copy_n(memory_.payload.begin(), lights.rgb.size(), lights.rgb.begin());
      show_lights(lights, at);
      break;
    }
    case kMicrophones:
      for (const double level : senses.sound) put16(microphone_counts(level));
      break;
    case kTimeOfFlight:
      put16(millimetres(senses.ahead_m));
      break;
    default:
      put8(0);
      break;  // button not pressed, no memory card; the switches answer 0
  }
}

// Offsets in the payload: 0 flags, 1 left, 3 right, 5 LEDs, 6 RGB, 18 sound. After a receiver error the firmware takes
// the bytes and does nothing, once.
void Firmware::set_all_actuators(hal::TimeNs at) {
  Memory& m = memory_;
  if (m.uart_error) {
    m.uart_error = false;
    event(at, "ignored", {{"command", "0xf7"}, {"why", "receiver error"}});
    return;
  }
  const unsigned flags = m.payload[0];
  if ((flags & 1U) != 0) calibrate(body_.sense(at));
  const bool avoid = (flags & 2U) != 0;
  if (avoid != m.obstacle_avoidance) event(at, "obstacle_avoidance", {{"on", avoid}});
  m.obstacle_avoidance = avoid;
  const auto left = static_cast<std::int16_t>(payload16(1));
  const auto right = static_cast<std::int16_t>(payload16(3));
  if ((flags & 4U) != 0) {
    left_.set_count(left);
    right_.set_count(right);
  } else {
    m.speed_left = left;
    m.speed_right = right;
    set_speeds(left, right, "F7", at);
  }
  const unsigned bits = m.payload[5];
  BodyCommand lights = m.lights;
  unsigned ring = lights.ring & 0b1010'1010U;  // LEDs 2, 4, 6, 8 are the RGB ones
  for (unsigned i = 0; i < 4; ++i) ring |= ((bits >> i) & 1U) << (2 * i);
  lights.ring = static_cast<std::uint8_t>(ring);
  lights.body_led = (bits & 0x10U) != 0;
  lights.front_led = (bits & 0x20U) != 0;
  std::copy_n(m.payload.begin() + 6, lights.rgb.size(), lights.rgb.begin());
  show_lights(lights, at);
  if (m.payload[18] != 0) event(at, "sound", {{"bits", m.payload[18]}});
}

// 103 bytes, in the order of the table in e-puck2_cpp_remote_library.
void Firmware::put_all_sensors(const BodySenses& senses) {
  const Tilt tilt = tilt_of(acceleration(senses, 0));
  for (const int value : acceleration(senses, 0)) put16(value);  // calibrated, unlike the answer to `a`
  put_float(tilt.acceleration_raw);
  put_float(tilt.orientation_deg);
  put_float(tilt.inclination_deg);
  for (const int value : gyro(senses)) put16(value);
  for (const double field : senses.magnetic_uT) put_float(static_cast<float>(field));
  put8(std::clamp(static_cast<int>(senses.temperature_C), -128, 127));
  for (const int value : proximity(senses, true)) put16(value);
  for (const double level : senses.light) put16(ambient_counts(level));
  put16(millimetres(senses.ahead_m));
  for (const double level : senses.sound) put16(microphone_counts(level));
  put16(left_.count());
  put16(right_.count());
  put16(battery_raw(senses));
  put8(0);                              // no memory card
  for (int i = 0; i < 3; ++i) put8(0);  // no remote control
  put8(options_.selector);
  for (const double g : ground(senses)) put16(ground_counts(g));
  for (int i = 0; i < 3; ++i) put16(0);  // ambient light beneath the robot
  put8(0);
}

}  // namespace tandem::bridges::epuck_emulator
