// Between SI and the numbers in a Thymio's variables. Pure.
//
// Source: the Thymio's programming interface, thymio.org. What an infrared sensor says is in the robot's kind.
#pragma once
#include <algorithm>
#include <cmath>
#include <cstdint>

#include "hal/device/leds.hpp"

namespace tandem::bridges::thymio {

/// Of the motors' targets; beyond, the firmware has nothing more to give.
inline constexpr std::int16_t kMostMotor = 500;

/// Target for a wheel that is to roll with `speed_m_s`, where `full_m_s` is its speed at 500. Not finite: 0.
inline std::int16_t motor_target(double speed_m_s, double full_m_s) noexcept {
  if (!std::isfinite(speed_m_s)) return 0;
  const double raw = std::clamp(speed_m_s / full_m_s, -1.0, 1.0) * kMostMotor;
  return static_cast<std::int16_t>(std::lround(raw));
}
inline double motor_m_s(std::int16_t speed, double full_m_s) noexcept {
  return speed * full_m_s / kMostMotor;
}

/// Specific force along the body's axis, from the word that the axis has: the sensor's axes point left, to the rear and
/// down, and show which way things fall; 23 is 9.81 m/s2.
inline double acceleration_m_s2(std::int16_t word) noexcept {
  return word * 9.81 / 23.0;
}

/// 0 silence to 1 full scale, from 0 to 255.
inline double sound_level(std::int16_t intensity) noexcept {
  return std::clamp(intensity / 255.0, 0.0, 1.0);
}

/// What `white` gives is 1; nothing is more.
inline double reflectance(std::int16_t delta, double white) noexcept {
  return std::clamp(delta / white, 0.0, 1.0);
}

/// 0 to 32, from 0 to 255.
inline std::int16_t lamp(std::uint8_t channel) noexcept {
  return static_cast<std::int16_t>((channel * 32 + 127) / 255);
}
/// Frequency of a tone; what is none is silence, 0.
inline std::int16_t whole_hz(float tone_Hz) noexcept {
  constexpr float kMost_Hz = 20000.0F;
  return tone_Hz > 0.0F ? static_cast<std::int16_t>(std::lround(std::min(tone_Hz, kMost_Hz))) : std::int16_t{0};
}

/// Lamps of one colour show the brightest channel.
inline std::int16_t yellow_lamp(hal::Rgb color) noexcept {
  return lamp(std::max({color.r, color.g, color.b}));
}

}  // namespace tandem::bridges::thymio
