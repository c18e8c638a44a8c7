// Facts of the emulated firmwares' motors and converters, from the robot's documentation.
#pragma once
#include <numbers>

#include "bridges/epuck_emulator/body.hpp"

namespace tandem::bridges::epuck_emulator {

inline constexpr int kTwelveBits = 4095;  // the largest number of the processor's converter
inline constexpr int kTenBits = 1023;     // … of the ground board's
inline constexpr double kGravity_m_s2 = 9.81;
inline constexpr double kGravityRaw = 800;  // what the accelerometer reads more for 1 g
// Lithium cell of boards with hardware 1.3: 2070 at 3.4 V, 2560 at 4.2 V, linear. Older ones compare with 3.4 V.
inline constexpr double kCellEmpty_V = 3.4, kCellFull_V = 4.2;
inline constexpr double kCellEmptyRaw = 2070, kCellFullRaw = 2560;

/// That a wheel rolls while its motor makes a step: 20 a turn, behind a gear of 50:1.
inline double step_m() {
  return 2.0 * std::numbers::pi * robot_part<hal::DifferentialDrive>().wheel_radius_m / (20 * 50);
}

}  // namespace tandem::bridges::epuck_emulator
