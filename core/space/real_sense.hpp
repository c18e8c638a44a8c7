// Senses that a real robot has of the others around it, beside those of its twin.
#pragma once
#include <cstdint>

namespace tandem::core {

/// Senses by which a real robot measures other real robots itself: its twin's sensors leave those out, so that nobody
/// is seen or heard twice. Bits of `RobotEntity::real_senses`.
enum class RealSense : std::uint8_t {
  Proximity = 1,
  Scanner = 2,
  Messages = 4,  ///< its own range-and-bearing board: between two robots that both have one
  OmniCamera = 8,
  LensCamera = 16,
  TimeOfFlight = 32
};

constexpr std::uint8_t bit(RealSense sense) noexcept {
  return static_cast<std::uint8_t>(sense);
}

}  // namespace tandem::core
