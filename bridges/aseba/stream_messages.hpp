// ASEBA messages over a byte stream: TCP, or the serial line of a CAN translator.
//
//   uint16 length of the payload | uint16 source | uint16 type | payload          little-endian
//
// There is no mark to find the next message by. When a length or a type cannot be, or a message does not end, the two
// sides are out of step: the link is Gone and must be reopened.
//
// Source: aseba-community/aseba, aseba/common/msg/msg.cpp, aseba/transport/buffer/vm-buffer.c.
#pragma once
#include <memory>

#include "bridges/aseba/message_link.hpp"
#include "bridges/link/link.hpp"

namespace tandem::bridges::aseba {

inline constexpr std::size_t kStreamHeader = 6;

enum class Stepping : std::uint8_t { InStep, TooLong, HalfWord };

/// Cuts a stream into messages. Pure; no input is undefined.
class StreamReader {
 public:
  /// Takes bytes from the front of `bytes` until a message is complete or none are left. True: `message()` is complete,
  /// valid until the next call; call again with the rest.
  bool take(std::span<const std::uint8_t>& bytes, hal::TimeNs at) noexcept;
  const MessageView& message() const noexcept { return message_; }
  /// Not InStep: the rest of the stream means nothing any more.
  Stepping stepping() const noexcept { return stepping_; }
  /// Bytes of a message have come, and not all.
  bool in_message() const noexcept { return size_ > 0; }

 private:
  std::array<std::uint8_t, kStreamHeader + kMostPayload> bytes_{};
  std::size_t size_ = 0;
  Stepping stepping_ = Stepping::InStep;
  MessageView message_;
};

struct StreamSettings {
  std::uint16_t source = kHost;
  hal::TimeNs message_timeout_ns = 500 * hal::kNsPerMs;  ///< for the rest of a message that has begun
  /// What could not leave within this time is dropped, and with it the link where a message was half on its way: an old
  /// command must not fire late.
  hal::TimeNs send_timeout_ns = 300 * hal::kNsPerMs;
};

class StreamMessages final : public MessageLink {
 public:
  explicit StreamMessages(std::unique_ptr<ByteLink> link, const StreamSettings& settings = {},
                          Clock clock = monotonic_ns);

  bool send(std::uint16_t type, std::span<const std::uint8_t> payload) noexcept override;
  bool receive(MessageView& message) noexcept override;
  bool wait(hal::TimeNs timeout_ns) noexcept override;
  int descriptor() const noexcept override { return link_->descriptor(); }
  void clear() noexcept override;
  Carrier state() const noexcept override { return state_; }
  MessageLinkStatistics statistics() const noexcept override { return statistics_; }
  std::string name() const override { return link_->name(); }

 private:
  static constexpr std::size_t kCapacity = 8192;  // bytes
  static constexpr std::size_t kMostQueued = 512;
  struct Queued {
    std::size_t left = 0;  // bytes still to be sent
    bool begun = false;
    hal::TimeNs since_ns = 0;
  };
  void flush(hal::TimeNs now) noexcept;
  void gone() noexcept;

  std::unique_ptr<ByteLink> link_;
  StreamSettings settings_;
  Clock clock_;
  StreamReader reader_;
  std::array<std::uint8_t, 2048> in_{};
  std::span<const std::uint8_t> unread_;
  hal::TimeNs arrived_ns_ = 0;
  std::array<std::uint8_t, kCapacity> out_{};
  std::size_t out_size_ = 0;
  std::array<Queued, kMostQueued> queue_{};  // the messages in `out_`, in order
  std::size_t queued_ = 0;
  Carrier state_ = Carrier::Up;
  MessageLinkStatistics statistics_;
};

}  // namespace tandem::bridges::aseba
