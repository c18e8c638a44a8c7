// Bytes to messages and back. Bytes come from a network on which anybody can speak: nothing in them is believed.
//
// The decoders that lcm-gen writes take lengths as they come: a negative one throws, a large one allocates first. So
// the whole length of a message is worked out from its counts before anything is decoded, and must be that of the data.
#pragma once
#include <cstddef>
#include <cstdint>
#include <optional>
#include <span>

#include "bridges/eyebot_messages/messages.hpp"

namespace tandem::bridges::eyebot_messages {

/// Why data is not the message that it was taken for.
enum class Flaw : std::uint8_t {
  None,
  WrongType,  ///< another type's fingerprint, or too short to have one
  WrongSize,  ///< cut short, with bytes behind its end, or larger than any such message
  BadCount,   ///< an array's length that is negative or too large
  BadText,    ///< a text's length that is none, or a text without its end
  NotFinite   ///< a number that counts is NaN or infinite, or an orientation is none
};
const char* flaw_name(Flaw flaw) noexcept;

inline constexpr std::size_t kHeaderEnd = 24;       ///< bytes: fingerprint and header, with which every message begins
inline constexpr std::size_t kMostElements = 4096;  ///< of an array
inline constexpr std::size_t kMostBytes = 64 * 1024;     ///< of a message but an image
inline constexpr std::size_t kMostImageBytes = 4 << 20;  ///< of an image's data

/// For every type of messages.hpp but the parts of others: Header, RabPacket, Blob.
template <class Message>
struct Codec {
  /// Takes over `data` when the result is None, else leaves `message` with values of no meaning. Allocates only where
  /// an array or a text has become longer than it ever was in this `message`.
  static Flaw decode(std::span<const std::byte> data, Message& message) noexcept;
  /// Writes the message into `buffer`. @returns the bytes written; none when they do not fit, or when a count is not
  /// the length of its array.
  static std::span<const std::byte> encode(const Message& message, std::span<std::byte> buffer) noexcept;
  /// The number that stands before every message of this type.
  static std::uint64_t fingerprint() noexcept;
};

template <class Message>
Flaw decode(std::span<const std::byte> data, Message& message) noexcept {
  return Codec<Message>::decode(data, message);
}
template <class Message>
std::span<const std::byte> encode(const Message& message, std::span<std::byte> buffer) noexcept {
  return Codec<Message>::encode(message, buffer);
}
template <class Message>
std::uint64_t fingerprint() noexcept {
  return Codec<Message>::fingerprint();
}

/// The header of whatever message `data` may be; nothing when it is too short. Says nothing of the rest.
std::optional<Header> peek_header(std::span<const std::byte> data) noexcept;

}  // namespace tandem::bridges::eyebot_messages
