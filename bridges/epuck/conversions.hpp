// Conversions between the e-puck's raw values and SI units. Each wire value has its conversion here and nowhere else.
#pragma once
#include <array>
#include <cstdint>
#include <vector>

#include "bridges/epuck/codec.hpp"
#include "bridges/epuck/line.hpp"
#include "hal/device/body_sensors.hpp"
#include "hal/device/infrared_response.hpp"
#include "hal/device/leds.hpp"
#include "hal/device/ring_sensors.hpp"

namespace tandem::bridges::epuck {

/// Steps from one reading of a 16-bit wheel counter to the next, the short way round.
/// Unambiguous while less than 32768 steps lie between: 32 s at full speed.
constexpr std::int32_t encoder_difference(std::int16_t newer, std::int16_t older) noexcept {
  return static_cast<std::int16_t>(
      static_cast<std::uint16_t>(static_cast<std::uint16_t>(newer) - static_cast<std::uint16_t>(older)));
}
/// Ambient light, 0 dark to 1 saturated, from counts that fall with brightness.
double light_level(std::uint16_t ambient) noexcept;
/// Reflectance, 0 black to 1 white.
double ground_reflectance(std::uint16_t counts) noexcept;
/// 0 silence to 1 full scale.
double sound_level(std::uint16_t volume) noexcept;
/// Turn rates about x ahead, y left, z up. The e-puck2's chip looks to the right, ahead and up.
std::array<double, 3> turn_rad_s(const std::array<std::int16_t, 3>& raw) noexcept;
/// The reading of the time-of-flight sensor; at most `range_m`, which also stands for nothing seen.
double time_of_flight_m(std::uint16_t mm, double range_m) noexcept;

struct BatteryState {
  double supply_V = 0.0;
  double charge = 0.0;  ///< 0 empty to 1 full, linear in the voltage
};

/// Conversions that depend on the robot: on its wheels, its infrared sensors and its battery.
class Conversions {
 public:
  explicit Conversions(const hal::RobotKind& kind);

  /// Nearest whole number of steps a second, within what the kind drives at most. Not finite: 0.
  StepsPerS to_steps_per_s(double speed_m_s) const noexcept;
  double to_m_s(StepsPerS speed) const noexcept { return to_m_s(static_cast<double>(speed.value)); }
  double to_m_s(double steps_per_s) const noexcept { return steps_per_s * metres_per_step_; }
  double steps_to_m(std::int64_t steps) const noexcept { return static_cast<double>(steps) * metres_per_step_; }

  /// Distance at which white paper gives `counts`: the sensors' response read backwards, straight between its points.
  /// 0 counts and fewer: the range of the sensor. The response's largest and more: contact, 0.
  double proximity_distance_m(double counts) const noexcept { return hal::distance_m_of(infrared_.response, counts); }
  /// The response read forwards: counts at `distance_m`; beyond the range 0.
  double proximity_counts(double distance_m) const noexcept { return hal::counts_at(infrared_.response, distance_m); }
  double proximity_range_m() const noexcept { return infrared_.range_m; }

  /// Raw value of `b`. Boards before HW1.3 only tell 1 (above empty) or 0: then the middle of what that leaves, or
  /// empty.
  BatteryState battery_state(std::uint16_t raw, Firmware firmware) const noexcept;

 private:
  double charge_at(double supply_V) const noexcept;

  double metres_per_step_;
  double most_steps_s_;
  hal::ProximityPart infrared_;
  hal::BatteryPart battery_;
};

/// A lamp of one colour is on when any channel is above half.
constexpr bool lamp_on(hal::Rgb color) noexcept {
  return color.r > 127 || color.g > 127 || color.b > 127;
}
/// 0 to 255 -> 0 to 100, rounded.
constexpr std::uint8_t to_percent(std::uint8_t channel) noexcept {
  return static_cast<std::uint8_t>((channel * 100U + 127U) / 255U);
}

}  // namespace tandem::bridges::epuck
