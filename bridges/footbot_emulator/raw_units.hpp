// Conversions between SI and the numbers in the modules' variables.
//
// Source, unless another stands beside: the control interface of the real robot as published with ARGoS 2.
#pragma once
#include <algorithm>
#include <cmath>
#include <cstdint>
#include <numbers>

#include "bridges/footbot_emulator/body.hpp"
#include "hal/device/distance_scanner.hpp"
#include "hal/device/ring_sensors.hpp"
#include "hal/device/turret.hpp"

namespace tandem::bridges::footbot_emulator {

namespace detail {
using std::numbers::pi;

/// Rounds and keeps within what a word can say; what is no number reads as 0.
inline std::int16_t raw(double value, double low = -32768.0, double high = 32767.0) {
  if (std::isnan(value)) return 0;
  return static_cast<std::int16_t>(std::lround(std::clamp(value, low, high)));
}
}  // namespace detail

/// Pulses per 5 ms that the wheels' controllers keep to: 30 cm/s.
inline constexpr int kMostSpeedRaw = 72;
inline constexpr double kPulsesPerMetre = 48312.0;  ///< of the wheels' encoders
inline constexpr double kPulsePeriod_s = 0.005;     ///< speeds are in pulses a period
inline double wheel_m_s(std::int16_t speed_raw) {
  const int pulses = std::clamp<int>(speed_raw, -kMostSpeedRaw, kMostSpeedRaw);
  return pulses / (kPulsesPerMetre * kPulsePeriod_s);
}

/// 0 nothing within reach, 4096 contact, straight between.
inline std::int16_t proximity_raw(double distance_m) {
  return detail::raw(4096.0 * (1.0 - distance_m / robot_part<hal::ProximityPart>().range_m), 0.0, 4096.0);
}
/// Light, and the ground sensors of the base: 0 to 4096.
inline std::int16_t level_raw(double level) {
  return detail::raw(4096.0 * level, 0.0, 4096.0);
}
/// The ground sensors between the tracks: 0 to 1024.
inline std::int16_t motor_ground_raw(double reflectance) {
  return detail::raw(1024.0 * reflectance, 0.0, 1024.0);
}
/// Centimetres from the robot's axis; -1 too near, -2 nothing.
inline std::int16_t scan_raw(double distance_m, double least_m, double most_m) {
  if (!(distance_m < most_m)) return -2;
  if (distance_m <= least_m) return -1;
  return detail::raw(100.0 * distance_m);
}
/// 32768 is half a turn; an angle is brought to (-pi, pi] first, and pi is -32768.
inline std::int16_t angle_raw(double angle_rad) {
  const double half_turns = std::remainder(angle_rad, 2.0 * detail::pi) / detail::pi;
  const long counts = std::isfinite(half_turns) ? std::lround(half_turns * 32768.0) : 0;
  return static_cast<std::int16_t>(counts == 32768 ? -32768 : counts);
}
inline double angle_rad(std::int16_t raw) {
  return raw * detail::pi / 32768.0;
}
/// The turret's speed goes from -4 to 4; 4 is a quarter turn a second [this project's convention].
inline double turret_rad_s(std::int16_t raw) {
  return std::clamp<int>(raw, -4, 4) * robot_part<hal::TurretPart>().turn_rad_s / 4.0;
}
/// Turns a minute.
inline double scanner_rad_s(std::int16_t raw) {
  const double most_rad_s = robot_part<hal::ScannerPart>().turn_rad_s;
  return std::clamp(raw * 2.0 * detail::pi / 60.0, -most_rad_s, most_rad_s);
}
/// Thousandths, of volts or of the weight, tenths of degrees a second [this project's convention].
inline std::int16_t thousandths_raw(double value) {
  return detail::raw(1000.0 * value);
}
inline std::int16_t gyro_raw(double turn_rad_s) {
  return detail::raw(turn_rad_s * 1800.0 / detail::pi);
}

}  // namespace tandem::bridges::footbot_emulator
