// ASEBA messages as bytes: the part common to every framing.
#pragma once
#include <algorithm>
#include <array>
#include <cstdint>
#include <span>

#include "hal/time.hpp"

namespace tandem::bridges::aseba {

inline constexpr std::size_t kMostWords = 258;               ///< in one payload
inline constexpr std::size_t kMostPayload = 2 * kMostWords;  ///< bytes
inline constexpr std::size_t kMostInner = kMostPayload + 2;  ///< type and payload, as CAN carries them
inline constexpr std::uint16_t kHost = 0;                    ///< source of what a host sends
inline constexpr std::size_t kNodeIds = 256;                 ///< a CAN identifier has room for no more

constexpr std::uint16_t read_u16(const std::uint8_t* bytes) noexcept {
  return static_cast<std::uint16_t>(bytes[0] | bytes[1] << 8U);
}
constexpr void write_u16(std::uint8_t* bytes, std::uint16_t value) noexcept {
  bytes[0] = static_cast<std::uint8_t>(value & 0xFFU);
  bytes[1] = static_cast<std::uint8_t>(value >> 8U);
}

/// A message that lies in a foreign buffer.
struct MessageView {
  std::uint16_t source = 0;
  std::uint16_t type = 0;
  std::span<const std::uint8_t> payload;
  hal::TimeNs at_ns = 0;  ///< arrival of its last byte, on the link's clock
};

/// A row of int16, little-endian, that lies in a foreign buffer.
class Words {
 public:
  constexpr Words() = default;
  /// An odd last byte is left out.
  constexpr explicit Words(std::span<const std::uint8_t> bytes) noexcept : bytes_(bytes.first(bytes.size() / 2 * 2)) {}
  constexpr std::size_t size() const noexcept { return bytes_.size() / 2; }
  constexpr bool empty() const noexcept { return bytes_.empty(); }
  constexpr std::int16_t operator[](std::size_t i) const noexcept {
    return static_cast<std::int16_t>(read_u16(bytes_.data() + 2 * i));
  }
  constexpr std::span<const std::uint8_t> bytes() const noexcept { return bytes_; }
  friend bool operator==(Words a, Words b) noexcept { return std::ranges::equal(a.bytes_, b.bytes_); }

 private:
  std::span<const std::uint8_t> bytes_;
};

/// A payload in the making, in a buffer of its own.
class Payload {
 public:
  /// Each returns false, and appends nothing, when there is no room.
  bool append(std::uint16_t word) noexcept {
    if (size_ + 2 > kMostPayload) return false;
    write_u16(bytes_.data() + size_, word);
    size_ += 2;
    return true;
  }
  bool append(std::span<const std::uint8_t> bytes) noexcept {
    if (size_ + bytes.size() > kMostPayload) return false;
    std::copy(bytes.begin(), bytes.end(), bytes_.begin() + static_cast<std::ptrdiff_t>(size_));
    size_ += bytes.size();
    return true;
  }
  bool append(std::span<const std::int16_t> words) noexcept {
    if (size_ + 2 * words.size() > kMostPayload) return false;
    for (const std::int16_t word : words) append(static_cast<std::uint16_t>(word));
    return true;
  }
  void clear() noexcept { size_ = 0; }
  std::size_t size() const noexcept { return size_; }
  std::span<const std::uint8_t> bytes() const noexcept { return {bytes_.data(), size_}; }
  Words words() const noexcept { return Words(bytes()); }

 private:
  std::array<std::uint8_t, kMostPayload> bytes_;
  std::size_t size_ = 0;
};

}  // namespace tandem::bridges::aseba
