#include "bridges/thymio/units.hpp"

#include <algorithm>
#include <cmath>

namespace tandem::bridges::thymio {
namespace {

constexpr double kGravity_m_s2 = 9.81;
constexpr double kCountsPerG = 23.0;
constexpr double kFullSound = 255.0;

}  // namespace

std::int16_t motor_target(double speed_m_s, double full_m_s) noexcept {
  if (!std::isfinite(speed_m_s)) return 0;
  const double raw = std::clamp(speed_m_s / full_m_s, -1.0, 1.0) * kMostMotor;
  return static_cast<std::int16_t>(std::lround(raw));
}

double motor_m_s(std::int16_t speed, double full_m_s) noexcept {
  return speed * full_m_s / kMostMotor;
}

double acceleration_m_s2(std::int16_t word) noexcept {
  return word * kGravity_m_s2 / kCountsPerG;
}

double sound_level(std::int16_t intensity) noexcept {
  return std::clamp(intensity / kFullSound, 0.0, 1.0);
}

double reflectance(std::int16_t delta, double white) noexcept {
  return std::clamp(delta / white, 0.0, 1.0);
}

std::int16_t lamp(std::uint8_t channel) noexcept {
  return static_cast<std::int16_t>((channel * 32 + 127) / 255);
}

std::int16_t whole_hz(float tone_Hz) noexcept {
  constexpr float kMost_Hz = 20000.0F;
  return tone_Hz > 0.0F ? static_cast<std::int16_t>(std::lround(std::min(tone_Hz, kMost_Hz))) : std::int16_t{0};
}

std::int16_t yellow_lamp(hal::Rgb color) noexcept {
  return lamp(std::max({color.r, color.g, color.b}));
}

}  // namespace tandem::bridges::thymio
