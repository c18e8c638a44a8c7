// CAN frames that carry ASEBA messages.
//
// Source: the ASEBA project, transport/can/can-net.c (identifiers and fragments).
#pragma once
#include <array>
#include <cstdint>
#include <string>
#include <vector>

#include "bridges/aseba_emulation/message.hpp"
#include "hal/time.hpp"

namespace tandem::bridges::footbot_emulator {

/// A standard data frame.
struct Frame {
  std::uint16_t id = 0;  ///< 11 bits: what part of a message in the upper 3, the sender in the lower 8
  std::uint8_t size = 0;
  std::array<std::uint8_t, 8> data{};
  friend bool operator==(const Frame&, const Frame&) = default;
};

/// A frame, and when its last bit had passed.
struct TimedFrame {
  Frame frame;
  hal::TimeNs at = 0;
  friend bool operator==(const TimedFrame&, const TimedFrame&) = default;
};

/// The upper bits of an identifier.
enum class Part : std::uint16_t { Middle = 0x000, First = 0x100, Last = 0x200, Whole = 0x300 };

/// How long a frame occupies a bus of 1 Mbit/s with the most stuff bits that there can be.
hal::TimeNs duration_ns(const Frame& frame) noexcept;

/// "300#11A00500".
std::string to_text(const Frame& frame);

using aseba_emulation::kMostPayload;
using aseba_emulation::Message;
namespace type = aseba_emulation::type;

/// In the order in which they are to be sent. The payload has at most `kMostPayload` bytes.
std::vector<Frame> to_frames(const Message& message);

}  // namespace tandem::bridges::footbot_emulator
