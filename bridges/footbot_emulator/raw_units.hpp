// Conversions between SI and the numbers in the modules' variables.
//
// Source, unless another stands beside: the control interface of the real robot as published with ARGoS 2.
#pragma once
#include <cstdint>

namespace tandem::bridges::footbot_emulator {

/// Pulses per 5 ms that the wheels' controllers keep to: 30 cm/s.
inline constexpr int kMostSpeedRaw = 72;
inline constexpr double kPulsesPerMetre = 48312.0;  ///< of the wheels' encoders
inline constexpr double kPulsePeriod_s = 0.005;     ///< speeds are in pulses a period
double wheel_m_s(std::int16_t speed_raw);

/// 0 nothing within reach, 4096 contact, straight between.
std::int16_t proximity_raw(double distance_m);
/// Light, and the ground sensors of the base: 0 to 4096.
std::int16_t level_raw(double level);
/// The ground sensors between the tracks: 0 to 1024.
std::int16_t motor_ground_raw(double reflectance);
/// Centimetres from the robot's axis; -1 too near, -2 nothing.
std::int16_t scan_raw(double distance_m, double least_m, double most_m);
/// 32768 is half a turn; an angle is brought to (-pi, pi] first, and pi is -32768.
std::int16_t angle_raw(double angle_rad);
double angle_rad(std::int16_t raw);
/// The turret's speed goes from -4 to 4; 4 is a quarter turn a second [this project's convention].
double turret_rad_s(std::int16_t raw);
/// Turns a minute.
double scanner_rad_s(std::int16_t raw);
/// Thousandths, of volts or of the weight, tenths of degrees a second [this project's convention].
std::int16_t thousandths_raw(double value);
std::int16_t gyro_raw(double turn_rad_s);

}  // namespace tandem::bridges::footbot_emulator
