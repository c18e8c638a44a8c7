#include "bridges/footbot_emulator/raw_units.hpp"

#include <algorithm>
#include <cmath>
#include <numbers>

#include "bridges/footbot_emulator/body.hpp"
#include "hal/device/distance_scanner.hpp"
#include "hal/device/ring_sensors.hpp"
#include "hal/device/turret.hpp"

namespace tandem::bridges::footbot_emulator {
namespace {

using std::numbers::pi;

/// Rounds and keeps within what a word can say; what is no number reads as 0.
std::int16_t raw(double value, double low = -32768.0, double high = 32767.0) {
  if (std::isnan(value)) return 0;
  return static_cast<std::int16_t>(std::lround(std::clamp(value, low, high)));
}

}  // namespace

double wheel_m_s(std::int16_t speed_raw) {
  const int pulses = std::clamp<int>(speed_raw, -kMostSpeedRaw, kMostSpeedRaw);
  return pulses / (kPulsesPerMetre * kPulsePeriod_s);
}

std::int16_t proximity_raw(double distance_m) {
  return raw(4096.0 * (1.0 - distance_m / robot_part<hal::ProximityPart>().range_m), 0.0, 4096.0);
}

std::int16_t level_raw(double level) {
  return raw(4096.0 * level, 0.0, 4096.0);
}

std::int16_t motor_ground_raw(double reflectance) {
  return raw(1024.0 * reflectance, 0.0, 1024.0);
}

std::int16_t scan_raw(double distance_m, double least_m, double most_m) {
  if (!(distance_m < most_m)) return -2;
  if (distance_m <= least_m) return -1;
  return raw(100.0 * distance_m);
}

std::int16_t angle_raw(double angle_rad) {
  const double half_turns = std::remainder(angle_rad, 2.0 * pi) / pi;
  const long counts = std::isfinite(half_turns) ? std::lround(half_turns * 32768.0) : 0;
  return static_cast<std::int16_t>(counts == 32768 ? -32768 : counts);
}

double angle_rad(std::int16_t raw) {
  return raw * pi / 32768.0;
}

double turret_rad_s(std::int16_t raw) {
  return std::clamp<int>(raw, -4, 4) * robot_part<hal::TurretPart>().turn_rad_s / 4.0;
}

double scanner_rad_s(std::int16_t raw) {
  const double most_rad_s = robot_part<hal::ScannerPart>().turn_rad_s;
  return std::clamp(raw * 2.0 * pi / 60.0, -most_rad_s, most_rad_s);
}

std::int16_t thousandths_raw(double value) {
  return raw(1000.0 * value);
}

std::int16_t gyro_raw(double turn_rad_s) {
  return raw(turn_rad_s * 1800.0 / pi);
}

}  // namespace tandem::bridges::footbot_emulator
