// Poses as whole numbers: micrometres, and 2^32 parts of a turn.
#pragma once
#include <cstdint>
#include <limits>
#include <numbers>
#include <span>

namespace tandem::core {

inline constexpr double kMicrometre = 1e-6;
inline constexpr double kBinaryAngle = std::numbers::pi / 2147483648.0;  ///< in rad: 2^32 are a turn
inline constexpr std::int32_t kNoNumber = std::numeric_limits<std::int32_t>::min();

/// `metres` to the nearest micrometre; beyond 2,147 m, or no number: kNoNumber. Both are of one size.
void to_micrometres(std::span<const double> metres, std::span<std::int32_t> out) noexcept;

/// The angle whose cosine and sine are given, also where those are not of length 1; the nearest of (-pi, pi].
void to_binary_angles(std::span<const double> cosine, std::span<const double> sine,
                      std::span<std::int32_t> out) noexcept;

}  // namespace tandem::core
