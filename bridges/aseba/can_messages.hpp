// ASEBA messages over a CAN bus.
#pragma once
#include <memory>

#include "bridges/aseba/fragments.hpp"
#include "bridges/aseba/message_link.hpp"
#include "bridges/can/can_link.hpp"
#include "bridges/link/link.hpp"

namespace tandem::bridges::aseba {

struct CanMessagesSettings {
  std::uint16_t source = kHost;
  /// Frames a second that are sent at most, in the mean: a bus of 1 Mbit/s carries some 7400, nodes' queues are short,
  /// and there is no flow control.
  double frames_per_s = 1850.0;
  std::size_t burst = 2 * kMostFrames;  ///< frames that may follow one another after a rest
  /// Frames that may wait for their turn; of more, `send` says that there is no room. Waiting is the business of
  /// the sender while it can still change its mind.
  std::size_t most_waiting = 32;
  /// What could not leave within this time is dropped: an old command must not fire late.
  hal::TimeNs send_timeout_ns = 100 * hal::kNsPerMs;
};

/// Cuts messages into frames and puts arriving ones together.
class CanMessages final : public MessageLink {
 public:
  explicit CanMessages(std::unique_ptr<CanLink> link, const CanMessagesSettings& settings = {},
                       Clock clock = monotonic_ns);

  bool send(std::uint16_t type, std::span<const std::uint8_t> payload) noexcept override;
  bool receive(MessageView& message) noexcept override;
  bool wait(hal::TimeNs timeout_ns) noexcept override;
  int descriptor() const noexcept override { return link_->descriptor(); }
  void clear() noexcept override;
  Carrier state() const noexcept override;
  MessageLinkStatistics statistics() const noexcept override;
  std::string name() const override { return link_->name(); }

  const CanLink& link() const noexcept { return *link_; }

 private:
  static constexpr std::size_t kCapacity = 512;  // frames
  struct Queued {
    CanFrame frame;
    bool first = false;  // of its message
    bool last = false;
    hal::TimeNs since_ns = 0;
  };
  Queued& at(std::size_t i) noexcept { return (*queue_)[(first_ + i) % kCapacity]; }
  void flush(hal::TimeNs now) noexcept;
  bool may_send(hal::TimeNs now) noexcept;
  void drop_all() noexcept;
  void watch_carrier() noexcept;

  std::unique_ptr<CanLink> link_;
  CanMessagesSettings settings_;
  Clock clock_;
  Assembler assembler_;
  std::unique_ptr<std::array<Queued, kCapacity>> queue_;
  std::size_t first_ = 0;
  std::size_t count_ = 0;
  bool broken_ = false;  // receivers wait for the rest of a message that was dropped
  double tokens_;
  hal::TimeNs tokens_at_ns_;
  bool up_ = true;
  MessageLinkStatistics statistics_;
};

}  // namespace tandem::bridges::aseba
