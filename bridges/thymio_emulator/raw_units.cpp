#include "bridges/thymio_emulator/raw_units.hpp"

#include <algorithm>
#include <cmath>

namespace tandem::bridges::thymio_emulator {
namespace {

/// Rounds and keeps within bounds; what is no number reads as the lower one.
std::int16_t raw(double value, double low, double high) {
  if (std::isnan(value)) return static_cast<std::int16_t>(low);
  return static_cast<std::int16_t>(std::lround(std::clamp(value, low, high)));
}

}  // namespace

double wheel_m_s(std::int16_t target_raw) {
  return kFullSpeed_m_s * std::clamp<int>(target_raw, -kMostMotorRaw, kMostMotorRaw) / kMostMotorRaw;
}

std::int16_t proximity_raw(double distance_m) {
  constexpr double kMost = 4505.0, kPeak_cm = 0.03, kWidth_cm2 = 73.0, kRange_cm = 14.0;
  const double x = 100.0 * std::max(distance_m, 0.0);
  if (!(x < kRange_cm)) return 0;
  if (x < kPeak_cm) return raw(kMost, 0.0, kMost);
  return raw(kMost * (kWidth_cm2 - kPeak_cm * kPeak_cm) / (x * x - 2.0 * kPeak_cm * x + kWidth_cm2), 0.0, kMost);
}

std::int16_t ground_raw(double reflectance) {
  return raw(10.0 + 810.0 * reflectance, 10.0, 820.0);
}

std::int16_t acceleration_raw(double force_m_s2) {
  return raw(23.0 * force_m_s2 / 9.81, -32.0, 32.0);
}

std::int16_t sound_raw(double level) {
  return raw(255.0 * level, 0.0, 255.0);
}

std::uint8_t lamp_channel(std::int16_t raw) {
  return static_cast<std::uint8_t>((std::clamp<int>(raw, 0, 32) * 255 + 16) / 32);
}

}  // namespace tandem::bridges::thymio_emulator
