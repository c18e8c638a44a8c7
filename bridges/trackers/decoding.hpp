// Decoders of messages of trackers. Messages come from a network on which anybody can speak: nothing in them is
// believed, and a message that is malformed in one place gives nothing at all.
#pragma once
#include <cstddef>
#include <cstdint>
#include <optional>
#include <span>
#include <vector>

#include "bridges/tracker.hpp"

namespace tandem::bridges::trackers {

inline constexpr std::size_t kMostPoses = 1024;  ///< of a message

/// Appends what a datagram of lines of JSON holds. False: it is none; nothing is appended then.
bool decode_json(std::span<const std::byte> data, std::vector<Sighting>& out);

/// Whether a datagram says of itself that it is of the compact form.
bool is_compact(std::span<const std::byte> data) noexcept;
/// The same for the compact form.
bool decode_compact(std::span<const std::byte> data, std::vector<Sighting>& out);

/// The same for a message of the LCM type tandem.poses_t.
bool decode_lcm(std::span<const std::byte> data, std::vector<Sighting>& out);

/// Zero stands for unknown.
inline std::optional<double> told(double value) noexcept {
  return value == 0.0 ? std::nullopt : std::optional(value);
}

/// Whether all numbers of a sighting are numbers, and its deviations positive.
bool is_sound(const Sighting& sighting) noexcept;

}  // namespace tandem::bridges::trackers
