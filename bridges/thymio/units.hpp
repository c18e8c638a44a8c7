// Between SI and the numbers in a Thymio's variables. Pure.
//
// Source: the Thymio's programming interface, thymio.org. What an infrared sensor says is in the robot's kind.
#pragma once
#include <cstdint>

#include "hal/device/leds.hpp"

namespace tandem::bridges::thymio {

/// Of the motors' targets; beyond, the firmware has nothing more to give.
inline constexpr std::int16_t kMostMotor = 500;

/// Target for a wheel that is to roll with `speed_m_s`, where `full_m_s` is its speed at 500. Not finite: 0.
std::int16_t motor_target(double speed_m_s, double full_m_s) noexcept;
double motor_m_s(std::int16_t speed, double full_m_s) noexcept;

/// Specific force along the body's axis, from the word that the axis has: the sensor's axes point left, to the rear and
/// down, and show which way things fall; 23 is 9.81 m/s2.
double acceleration_m_s2(std::int16_t word) noexcept;

/// 0 silence to 1 full scale, from 0 to 255.
double sound_level(std::int16_t intensity) noexcept;

/// What `white` gives is 1; nothing is more.
double reflectance(std::int16_t delta, double white) noexcept;

/// 0 to 32, from 0 to 255.
std::int16_t lamp(std::uint8_t channel) noexcept;
/// Frequency of a tone; what is none is silence, 0.
std::int16_t whole_hz(float tone_Hz) noexcept;

/// Lamps of one colour show the brightest channel.
std::int16_t yellow_lamp(hal::Rgb color) noexcept;

}  // namespace tandem::bridges::thymio
