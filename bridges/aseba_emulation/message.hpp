// ASEBA messages as an emulated robot's nodes see them.
//
// Source: the ASEBA project, common/consts.h.
#pragma once
#include <cstddef>
#include <cstdint>
#include <string_view>
#include <vector>

namespace tandem::bridges::aseba_emulation {

inline constexpr std::size_t kMostPayload = 516;  ///< bytes: 258 words

struct Message {
  std::uint16_t source = 0;  ///< 0 is the host
  std::uint16_t type = 0;    ///< below 0x8000: a user event of that number
  std::vector<std::uint8_t> payload{};

  std::size_t words() const noexcept { return payload.size() / 2; }
  /// Word `i` of the payload, little-endian; 0 beyond its end.
  std::uint16_t word(std::size_t i) const noexcept;
  Message& add(std::uint16_t word);
  /// One byte of length, then at most 255 bytes.
  Message& add_text(std::string_view text);
  friend bool operator==(const Message&, const Message&) = default;
};

/// Message types.
namespace type {
inline constexpr std::uint16_t kDescription = 0x9000;
inline constexpr std::uint16_t kNamedVariable = 0x9001;
inline constexpr std::uint16_t kLocalEvent = 0x9002;
inline constexpr std::uint16_t kNativeFunction = 0x9003;
inline constexpr std::uint16_t kVariables = 0x9005;
inline constexpr std::uint16_t kDivisionByZero = 0x9007;
inline constexpr std::uint16_t kExecutionKilled = 0x9008;
inline constexpr std::uint16_t kNodeError = 0x9009;
inline constexpr std::uint16_t kExecutionState = 0x900A;
inline constexpr std::uint16_t kBreakpointSetResult = 0x900B;
inline constexpr std::uint16_t kNodePresent = 0x900C;
inline constexpr std::uint16_t kGetDescription = 0xA000;
inline constexpr std::uint16_t kSetBytecode = 0xA001;
inline constexpr std::uint16_t kReset = 0xA002;
inline constexpr std::uint16_t kRun = 0xA003;
inline constexpr std::uint16_t kPause = 0xA004;
inline constexpr std::uint16_t kStep = 0xA005;
inline constexpr std::uint16_t kStop = 0xA006;
inline constexpr std::uint16_t kGetExecutionState = 0xA007;
inline constexpr std::uint16_t kBreakpointSet = 0xA008;
inline constexpr std::uint16_t kBreakpointClear = 0xA009;
inline constexpr std::uint16_t kBreakpointClearAll = 0xA00A;
inline constexpr std::uint16_t kGetVariables = 0xA00B;
inline constexpr std::uint16_t kSetVariables = 0xA00C;
inline constexpr std::uint16_t kWriteBytecode = 0xA00D;
inline constexpr std::uint16_t kReboot = 0xA00E;
inline constexpr std::uint16_t kSuspend = 0xA00F;
inline constexpr std::uint16_t kGetNodeDescription = 0xA010;
inline constexpr std::uint16_t kListNodes = 0xA011;
}  // namespace type

}  // namespace tandem::bridges::aseba_emulation
