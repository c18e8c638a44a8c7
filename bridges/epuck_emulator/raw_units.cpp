#include "bridges/epuck_emulator/raw_units.hpp"

#include <algorithm>
#include <cmath>
#include <numbers>

#include "bridges/epuck_emulator/converters.hpp"
#include "hal/device/ring_sensors.hpp"

namespace tandem::bridges::epuck_emulator {
namespace {

constexpr double kDegrees = 180.0 / std::numbers::pi;

/// Rounds and keeps within what the converter can say; what is no number reads as `low`.
int counts(double value, int low, int high) {
  if (std::isnan(value)) return low;
  return static_cast<int>(std::lround(std::clamp(value, static_cast<double>(low), static_cast<double>(high))));
}

}  // namespace

int proximity_counts(double distance_m) {
  const auto& curve = robot_part<hal::ProximityPart>().response;
  if (!(distance_m > curve.front().distance_m)) return counts(curve.front().counts, 0, kTwelveBits);
  for (std::size_t i = 1; i < curve.size(); ++i) {
    if (distance_m > curve[i].distance_m) continue;
    const double share = (distance_m - curve[i - 1].distance_m) / (curve[i].distance_m - curve[i - 1].distance_m);
    return counts(curve[i - 1].counts + share * (curve[i].counts - curve[i - 1].counts), 0, kTwelveBits);
  }
  return 0;
}

int ambient_counts(double level) {
  return counts(kTwelveBits * (1.0 - level), 0, kTwelveBits);
}

int ground_counts(double reflectance) {
  return counts(reflectance * kTenBits, 0, kTenBits);
}

int microphone_counts(double level) {
  return counts(level * kTwelveBits, 0, kTwelveBits);
}

int acceleration_counts(double force_m_s2) {
  return counts(force_m_s2 / kGravity_m_s2 * kGravityRaw, -kTwelveBits, kTwelveBits);
}

int gyro_counts(double turn_rad_s) {
  return counts(turn_rad_s * kDegrees * 32768.0 / 250.0, -32768, 32767);
}

int battery_counts(double battery_V) {
  const double share = (battery_V - kCellEmpty_V) / (kCellFull_V - kCellEmpty_V);
  return counts(kCellEmptyRaw + share * (kCellFullRaw - kCellEmptyRaw), 0, kTwelveBits);
}

int battery_counts_epuck2(double battery_V) {
  return counts(battery_V * 330.0 / (220.0 + 330.0) * 4096.0 / 3.0, 0, kTwelveBits);
}

int battery_percent(double battery_V) {
  const double share = (battery_V - kCellEmpty_V) / (kCellFull_V - kCellEmpty_V);
  return counts(100.0 * share, 0, 100);
}

Tilt tilt_of(const std::array<int, 3>& raw) {
  const double left = raw[0];
  const double ahead = raw[1];
  const double up = raw[2];
  const double flat = std::hypot(ahead, left);
  Tilt tilt;
  tilt.acceleration_raw = static_cast<float>(std::hypot(flat, up));
  const double orientation_deg = std::atan2(left, ahead) * kDegrees;
  tilt.orientation_deg = static_cast<float>(orientation_deg < 0.0 ? orientation_deg + 360.0 : orientation_deg);
  tilt.inclination_deg = static_cast<float>(std::atan2(flat, up) * kDegrees);
  return tilt;
}

}  // namespace tandem::bridges::epuck_emulator
