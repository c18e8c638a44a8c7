// Conversions from SI to the counts of the robot's converters.
#pragma once
#include <algorithm>
#include <cmath>
#include <numbers>

#include "bridges/epuck_emulator/body.hpp"
#include "bridges/epuck_emulator/converters.hpp"
#include "hal/device/ring_sensors.hpp"

namespace tandem::bridges::epuck_emulator {

namespace detail {
inline constexpr double kDegrees = 180.0 / std::numbers::pi;

/// Rounds and keeps within what the converter can say; what is no number reads as `low`.
inline int counts(double value, int low, int high) {
  if (std::isnan(value)) return low;
  return static_cast<int>(std::lround(std::clamp(value, static_cast<double>(low), static_cast<double>(high))));
}
}  // namespace detail

/// A sensor's reading with nothing in sight, before calibration. The real offsets differ from sensor to sensor; one
/// value serves to tell calibrated from uncalibrated answers.
inline constexpr int kInfraredOffsetRaw = 40;

/// Infrared response above the offset: the kind's curve, straight between its knots; 0 beyond its end.
inline int proximity_counts(double distance_m) {
  const auto& curve = robot_part<hal::ProximityPart>().response;
  if (!(distance_m > curve.front().distance_m)) return detail::counts(curve.front().counts, 0, kTwelveBits);
  for (std::size_t i = 1; i < curve.size(); ++i) {
    if (distance_m > curve[i].distance_m) continue;
    const double share = (distance_m - curve[i - 1].distance_m) / (curve[i].distance_m - curve[i - 1].distance_m);
    return detail::counts(curve[i - 1].counts + share * (curve[i].counts - curve[i - 1].counts), 0, kTwelveBits);
  }
  return 0;
}
/// Larger is darker.
inline int ambient_counts(double level) {
  return detail::counts(kTwelveBits * (1.0 - level), 0, kTwelveBits);
}
inline int ground_counts(double reflectance) {
  return detail::counts(reflectance * kTenBits, 0, kTenBits);
}
inline int microphone_counts(double level) {
  return detail::counts(level * kTwelveBits, 0, kTwelveBits);
}
inline int acceleration_counts(double force_m_s2) {
  return detail::counts(force_m_s2 / kGravity_m_s2 * kGravityRaw, -kTwelveBits, kTwelveBits);
}
/// e-puck2: 250 degrees a second are 32768.
inline int gyro_counts(double turn_rad_s) {
  return detail::counts(turn_rad_s * detail::kDegrees * 32768.0 / 250.0, -32768, 32767);
}
/// e-puck1, hardware 1.3: 2070 at 3.4 V, 2560 at 4.2 V.
inline int battery_counts(double battery_V) {
  const double share = (battery_V - kCellEmpty_V) / (kCellFull_V - kCellEmpty_V);
  return detail::counts(kCellEmptyRaw + share * (kCellFullRaw - kCellEmptyRaw), 0, kTwelveBits);
}
/// e-puck2: 12 bits of 3.0 V behind a divider of 220 and 330 kOhm.
inline int battery_counts_epuck2(double battery_V) {
  return detail::counts(battery_V * 330.0 / (220.0 + 330.0) * 4096.0 / 3.0, 0, kTwelveBits);
}
/// 0 at 3.4 V, 100 at 4.2 V.
inline int battery_percent(double battery_V) {
  const double share = (battery_V - kCellEmpty_V) / (kCellFull_V - kCellEmpty_V);
  return detail::counts(100.0 * share, 0, 100);
}

/// What the firmware derives from the accelerometer, whose axes point left, forward and up.
struct Tilt {
  float acceleration_raw = 0.0F;  ///< length of the vector of counts
  float orientation_deg = 0.0F;   ///< of its part in the plane of the body, counter-clockwise from ahead, 0 to 360
  float inclination_deg = 0.0F;   ///< between it and the body's vertical, 0 to 180
};
inline Tilt tilt_of(const std::array<int, 3>& raw) {
  const double left = raw[0];
  const double ahead = raw[1];
  const double up = raw[2];
  const double flat = std::hypot(ahead, left);
  Tilt tilt;
  tilt.acceleration_raw = static_cast<float>(std::hypot(flat, up));
  const double orientation_deg = std::atan2(left, ahead) * detail::kDegrees;
  tilt.orientation_deg = static_cast<float>(orientation_deg < 0.0 ? orientation_deg + 360.0 : orientation_deg);
  tilt.inclination_deg = static_cast<float>(std::atan2(flat, up) * detail::kDegrees);
  return tilt;
}

}  // namespace tandem::bridges::epuck_emulator
