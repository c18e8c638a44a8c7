// Interface of a link for ASEBA messages, whatever the framing: CAN fragments, or the byte stream of TCP and serial
// lines.
//
// One thread at a time uses a link. `send` and `receive` never wait. Messages leave in the order in which they were
// taken, whole or not at all.
#pragma once
#include <functional>
#include <memory>
#include <string>

#include "bridges/aseba/wire.hpp"
#include "hal/result.hpp"

namespace tandem::bridges::aseba {

enum class Carrier : std::uint8_t {
  Up,
  Down,  ///< nothing passes at present (bus off, interface down, being opened); comes up by itself
  Gone   ///< must be reopened
};

/// Counted since the link was made. What was sent half or dropped on the way out is `dropped`, not `sent`.
struct MessageLinkStatistics {
  std::uint64_t received = 0;
  std::uint64_t sent = 0;         ///< messages whose last byte left
  std::uint64_t no_room = 0;      ///< `send` found the queue full
  std::uint64_t refused = 0;      ///< `send` while not Up, or too long
  std::uint64_t dropped = 0;      ///< taken, and given up: cleared, not sent in time, carrier lost
  std::uint64_t times_stuck = 0;  ///< the queue did not move for too long; CAN: does anybody acknowledge?
  std::uint64_t broken_in = 0;    ///< arrived incomplete or not understood by the framing
  std::uint64_t times_down = 0;
  std::uint64_t times_up = 0;  ///< came up again, or was reopened
};

class MessageLink {
 public:
  virtual ~MessageLink() = default;

  /// Queues a message; it leaves at once when there is room, else with later calls to any function. False: not taken.
  virtual bool send(std::uint16_t type, std::span<const std::uint8_t> payload) noexcept = 0;
  /// The oldest message that has arrived; valid until the next call to any function. False when there is none.
  virtual bool receive(MessageView& message) noexcept = 0;
  /// Waits until a `receive` is worth while or the state changes, at most `timeout_ns`.
  virtual bool wait(hal::TimeNs timeout_ns) noexcept = 0;
  /// What `poll` can wait on for input, for those who must not hold the link while they wait; -1: there is none.
  virtual int descriptor() const noexcept { return -1; }
  /// Forgets what is queued; a message that is half on its way is finished first, since receivers would glue its
  /// beginning to the next one.
  virtual void clear() noexcept = 0;
  /// As of the last call to another function.
  virtual Carrier state() const noexcept = 0;
  virtual MessageLinkStatistics statistics() const noexcept = 0;
  /// For messages: "can:can0", "tcp:robot:33333".
  virtual std::string name() const = 0;
};

/// Opens a link, or reopens it when it is Gone. May block for seconds: call it from a worker thread.
using MessageLinkOpener = std::function<hal::Result<std::unique_ptr<MessageLink>>()>;

}  // namespace tandem::bridges::aseba
