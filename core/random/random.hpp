// Random numbers without a generator: a function of (seed, entity, stream, tick), the same on every thread and machine.
#pragma once
#include <array>
#include <cmath>
#include <cstdint>
#include <numbers>
#include <string_view>

#include "hal/philox.hpp"

namespace tandem::core {

/// Owner of a random stream. Two streams never share a number.
enum class Stream : std::uint32_t {
  Placement = 1,
  Orientation,
  ControllerSeed,
  WheelNoise,
  EncoderNoise,
  ProximityNoise,
  LightNoise,
  GroundNoise,
  AccelerometerNoise,
  MicrophoneNoise,
  BatteryNoise,
  RabNoise,
  RabLoss,
  ClockNoise,
  SendLoss,
  FlightNoise,
  PositioningNoise,
  TurretNoise,
  TurretEncoderNoise,
  GripperNoise,
  GripperSlip,
  ScannerNoise,
  ScannerDriveNoise,
  GyroscopeNoise,
  OdometryNoise,
  TreelSlant,
  MotorGroundNoise,
  OmniCameraNoise,
  OmniCameraMiss,
  CameraNoise,
  CameraMiss,
  AttitudeNoise,
  TaskNoise,
  FlightStateNoise,
  AltimeterNoise,
  HeadNoise,
  HeadEncoderNoise,
  LampNoise,
  GyroscopeBias,
  TimeOfFlightNoise,
  CliffNoise,
  WheelBias,
  Plugin = 255,  ///< of parts from outside, with a seed of their own: `own_seed`
};

/// The seed for the draws of a part that has no stream here: different for every name, e.g. "thermometer noise".
constexpr std::uint64_t own_seed(std::uint64_t seed, std::string_view name) noexcept {
  std::uint64_t own = 14'695'981'039'346'656'037ULL;  // FNV-1a
  for (const char c : name) own = (own ^ static_cast<unsigned char>(c)) * 1'099'511'628'211ULL;
  return own ^ seed;
}

/// Four independent 32-bit numbers. `index` tells draws of one tick apart (0 to 2^24 - 1).
inline std::array<std::uint32_t, 4> draw(std::uint64_t seed, std::uint32_t entity, Stream stream, std::int64_t tick,
                                         std::uint32_t index = 0) noexcept {
  const auto t = static_cast<std::uint64_t>(tick);
  return hal::philox({entity, static_cast<std::uint32_t>(stream) | (index << 8), static_cast<std::uint32_t>(t),
                      static_cast<std::uint32_t>(t >> 32)},
                     seed);
}

/// In [0, 1), 24 bits.
inline float to_unit_float(std::uint32_t bits) noexcept {
  return static_cast<float>(bits >> 8) * 0x1p-24F;
}

/// In [0, 1), 32 bits.
inline double to_unit(std::uint32_t bits) noexcept {
  return static_cast<double>(bits) * 0x1p-32;
}

/// In [0, 1), 53 bits.
inline double to_unit(std::uint32_t high, std::uint32_t low) noexcept {
  return static_cast<double>(((static_cast<std::uint64_t>(high) << 32) | low) >> 11) * 0x1p-53;
}

/// Two independent draws from the standard normal distribution [Box and Muller 1958].
inline std::array<double, 2> to_normal(std::uint32_t a, std::uint32_t b) noexcept {
  const double radius = std::sqrt(-2.0 * std::log(1.0 - to_unit(a)));
  const double angle = 2.0 * std::numbers::pi * to_unit(b);
  return {radius * std::cos(angle), radius * std::sin(angle)};
}

}  // namespace tandem::core
