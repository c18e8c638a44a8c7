// ASEBA messages in CAN frames, both ways. Pure; no input is undefined.
//
//   identifier: 2 bits kind (0 NORMAL, 1 START, 2 STOP, 3 SMALL) above 8 bits source; standard data frames only.
//   data:       type and payload back to back, little-endian; up to 8 bytes are one SMALL, more are START (8 bytes),
//               NORMAL (8 bytes) as long as more than 8 bytes remain, STOP (1 to 8 bytes).
//
// Fragments have no number and no checksum of their own: a lost NORMAL shows only in the message's length, which
// its caller must check.
//
// Sources: aseba-community/aseba, aseba/transport/can/can-net.c, aseba/transport/dashel_plugins/socketcan.cpp.
#pragma once
#include <memory>
#include <optional>
#include <vector>

#include "bridges/aseba/wire.hpp"
#include "bridges/can/frame.hpp"
#include "bridges/can/socketcan_link.hpp"

namespace tandem::bridges::aseba {

inline constexpr std::size_t kMostFrames = (kMostInner + 7) / 8;

/// Lets ASEBA's frames through and no others.
std::vector<CanFilter> aseba_filters();

/// How many frames a message with so many bytes of payload takes.
constexpr std::size_t frames_for(std::size_t payload_bytes) noexcept {
  return (payload_bytes + 2 + 7) / 8;
}

/// Frame number `index` of a message. `source` is cut to 8 bits; `index` below `frames_for(payload.size())`.
CanFrame fragment(std::uint16_t source, std::uint16_t type, std::span<const std::uint8_t> payload,
                  std::size_t index) noexcept;

/// The frame that ends a message whose rest will never be sent: receivers drop it, or see one more word 0. ASEBA's own
/// receivers would else glue what they have to the next message.
CanFrame closing_frame(std::uint16_t source) noexcept;

struct AssemblerStatistics {
  std::uint64_t frames = 0;
  std::uint64_t messages = 0;
  std::uint64_t foreign = 0;       ///< frames that are not ASEBA's: extended, remote, identifier of 0x400 or more
  std::uint64_t bad_length = 0;    ///< START or NORMAL without 8 bytes, SMALL below 2, empty STOP
  std::uint64_t lost_stop = 0;     ///< messages dropped because another began
  std::uint64_t stray_normal = 0;  ///< without a START before
  std::uint64_t stray_stop = 0;
  std::uint64_t too_long = 0;   ///< messages dropped
  std::uint64_t timed_out = 0;  ///< messages dropped because nothing followed
};

/// Puts messages together again, of all sources at once. Fixed memory, 150 kB.
class Assembler {
 public:
  static constexpr hal::TimeNs kLongestGap = 100 * hal::kNsPerMs;  ///< between frames of one message

  Assembler();

  /// The message that `frame` completes; it is valid until the next call. Judges gaps by the frames' stamps.
  std::optional<MessageView> push(const CanFrame& frame) noexcept;
  /// Drops messages to which nothing was added for too long.
  void expire(hal::TimeNs now) noexcept;
  /// Drops every message that is not complete: the bus was off.
  void clear() noexcept;

  std::size_t open_messages() const noexcept { return open_; }
  const AssemblerStatistics& statistics() const noexcept { return statistics_; }

 private:
  struct Source {
    std::array<std::uint8_t, kMostInner> bytes;
    std::uint16_t size = 0;  // 0: nothing is open
    hal::TimeNs last_ns = 0;
  };
  void begin(Source& source, const CanFrame& frame) noexcept;
  bool extend(Source& source, const CanFrame& frame) noexcept;
  void drop(Source& source, std::uint64_t& counter) noexcept;
  std::optional<MessageView> deliver(std::uint16_t id, std::span<const std::uint8_t> bytes, hal::TimeNs at) noexcept;

  std::unique_ptr<std::array<Source, kNodeIds>> sources_;
  std::array<std::uint8_t, 8> small_{};
  std::size_t open_ = 0;
  AssemblerStatistics statistics_;
};

}  // namespace tandem::bridges::aseba
