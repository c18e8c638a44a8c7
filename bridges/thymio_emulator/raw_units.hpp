// Conversions between SI and the numbers in a Thymio's variables.
//
// Sources: the Thymio's programming interface, thymio.org; [Enki] its model in the simulator of ASEBA's playground,
// enki/robots/thymio2/Thymio2.cpp.
#pragma once
#include <algorithm>
#include <cmath>
#include <cstdint>

namespace tandem::bridges::thymio_emulator {

namespace detail {
/// Rounds and keeps within bounds; what is no number reads as the lower one.
inline std::int16_t raw(double value, double low, double high) {
  if (std::isnan(value)) return static_cast<std::int16_t>(low);
  return static_cast<std::int16_t>(std::lround(std::clamp(value, low, high)));
}
}  // namespace detail

/// About 20 cm/s at 500; the firmware gives no more.
inline constexpr int kMostMotorRaw = 500;
inline constexpr double kFullSpeed_m_s = 0.2;
inline double wheel_m_s(std::int16_t target_raw) {
  return kFullSpeed_m_s * std::clamp<int>(target_raw, -kMostMotorRaw, kMostMotorRaw) / kMostMotorRaw;
}

/// 4505 at contact, about 1230 at 14 cm, nothing beyond [Enki, perpendicular to a wall].
inline std::int16_t proximity_raw(double distance_m) {
  constexpr double kMost = 4505.0, kPeak_cm = 0.03, kWidth_cm2 = 73.0, kRange_cm = 14.0;
  const double x = 100.0 * std::max(distance_m, 0.0);
  if (!(x < kRange_cm)) return 0;
  if (x < kPeak_cm) return detail::raw(kMost, 0.0, kMost);
  return detail::raw(kMost * (kWidth_cm2 - kPeak_cm * kPeak_cm) / (x * x - 2.0 * kPeak_cm * x + kWidth_cm2), 0.0,
                     kMost);
}
/// About 820 from white ground, 10 from black [Enki, its two ends].
inline std::int16_t ground_raw(double reflectance) {
  return detail::raw(10.0 + 810.0 * reflectance, 10.0, 820.0);
}
/// 23 is 9.81 m/s2, within +-32.
inline std::int16_t acceleration_raw(double force_m_s2) {
  return detail::raw(23.0 * force_m_s2 / 9.81, -32.0, 32.0);
}
/// 0 to 255.
inline std::int16_t sound_raw(double level) {
  return detail::raw(255.0 * level, 0.0, 255.0);
}

/// 0 to 255 from a lamp's 0 to 32; other numbers are the nearest of them.
inline std::uint8_t lamp_channel(std::int16_t raw) {
  return static_cast<std::uint8_t>((std::clamp<int>(raw, 0, 32) * 255 + 16) / 32);
}

}  // namespace tandem::bridges::thymio_emulator
