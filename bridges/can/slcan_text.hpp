// The text that slcan adapters speak: LAWICEL's ASCII protocol, both ways. Pure functions; no input is undefined.
//
// A line is a letter and what belongs to it, ended by CR; an adapter says CR alone for yes and BEL for no. Identifiers
// have 3 or 8 hexadecimal digits, then comes one digit for the length and two for every byte.
//
// Sources: LAWICEL CAN232 and CANUSB manuals; Linux kernel, drivers/net/can/slcan/slcan-core.c (the messages s and e).
#pragma once
#include <array>
#include <cstdint>
#include <optional>
#include <string_view>

#include "bridges/can/can_link.hpp"

namespace tandem::bridges {

/// One line to be sent, with its CR.
struct SlcanLine {
  std::array<char, 32> text{};
  std::size_t size = 0;
  std::string_view view() const noexcept { return {text.data(), size}; }
};

/// "t300411A00500\r". `frame` must be valid.
SlcanLine slcan_line(const CanFrame& frame) noexcept;

/// The digit of "Sn" for a bit rate, or empty when slcan has none for it.
std::optional<char> slcan_rate_digit(std::uint32_t bits_per_s) noexcept;

/// An answer of an adapter.
struct SlcanSaying {
  enum class What : std::uint8_t {
    Yes,        ///< CR: done
    No,         ///< BEL: not done
    Confirmed,  ///< z or Z: a frame was taken
    Frame,
    State,    ///< s: of the controller
    Error,    ///< e: errors on the bus
    Flags,    ///< F: status flags, read and thereby cleared
    Version,  ///< V, v, N: versions and serial number
    Malformed
  };
  What what = What::Malformed;
  CanFrame frame;                     ///< of Frame
  BusState state = BusState::Active;  ///< of State
  std::uint8_t flags = 0;             ///< of Flags
  bool no_acknowledge = false;        ///< of Error
  bool overrun = false;               ///< of Error
};

/// Bits of the flags. [LAWICEL CANUSB manual]
inline constexpr std::uint8_t kSlcanReceiveFull = 0x01;
inline constexpr std::uint8_t kSlcanWarning = 0x04;
inline constexpr std::uint8_t kSlcanOverrun = 0x08;
inline constexpr std::uint8_t kSlcanPassive = 0x20;

/// Understands one line, without its end.
SlcanSaying parse_slcan_line(std::string_view line) noexcept;

/// Cuts what an adapter sends into sayings.
class SlcanReader {
 public:
  /// True when `byte` ended a saying, which `saying()` then is.
  bool push(std::uint8_t byte) noexcept;
  const SlcanSaying& saying() const noexcept { return saying_; }

 private:
  std::array<char, 64> text_{};
  std::size_t size_ = 0;
  bool too_long_ = false;
  SlcanSaying saying_;
};

}  // namespace tandem::bridges
