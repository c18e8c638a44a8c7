// Conversions between SI and the numbers in a Thymio's variables.
//
// Sources: the Thymio's programming interface, thymio.org; [Enki] its model in the simulator of ASEBA's playground,
// enki/robots/thymio2/Thymio2.cpp.
#pragma once
#include <cstdint>

namespace tandem::bridges::thymio_emulator {

/// About 20 cm/s at 500; the firmware gives no more.
inline constexpr int kMostMotorRaw = 500;
inline constexpr double kFullSpeed_m_s = 0.2;
double wheel_m_s(std::int16_t target_raw);

/// 4505 at contact, about 1230 at 14 cm, nothing beyond [Enki, perpendicular to a wall].
std::int16_t proximity_raw(double distance_m);
/// About 820 from white ground, 10 from black [Enki, its two ends].
std::int16_t ground_raw(double reflectance);
/// 23 is 9.81 m/s2, within +-32.
std::int16_t acceleration_raw(double force_m_s2);
/// 0 to 255.
std::int16_t sound_raw(double level);

/// 0 to 255 from a lamp's 0 to 32; other numbers are the nearest of them.
std::uint8_t lamp_channel(std::int16_t raw);

}  // namespace tandem::bridges::thymio_emulator
