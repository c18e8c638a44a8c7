// CAN links: carriers of frames of any make.
//
// One thread at a time uses a link. `send` and `receive` never wait. Frames leave in the order in which they were
// taken: higher layers cut messages into frames whose identifiers say nothing about their order.
#pragma once
#include <cstdint>
#include <functional>
#include <memory>
#include <string>

#include "bridges/can/frame.hpp"
#include "hal/result.hpp"

namespace tandem::bridges {

/// State of the controller on its bus, best first.
enum class BusState : std::uint8_t {
  Active,
  Warning,  ///< 96 errors and more: cable, termination, bit rate?
  Passive,  ///< 128 and more; often for want of acknowledgements
  BusOff,   ///< the controller gave up; nothing passes until it is restarted
  Down,     ///< the interface is switched off; becomes Active by itself when it is switched on
  Gone      ///< adapter pulled out, line hung up: the link must be reopened
};
/// Whether frames can pass.
constexpr bool can_pass(BusState state) noexcept {
  return state < BusState::BusOff;
}

/// Outcome of sending a frame.
enum class Sent : std::uint8_t {
  Taken,   ///< it is in the transmit queue of kernel or adapter
  Full,    ///< no room at present: try the same frame again later
  Refused  ///< no frame passes at present, or it is no valid frame: forget it
};

/// Counted since the link was made.
struct CanStatistics {
  std::uint64_t frames_in = 0;
  std::uint64_t frames_out = 0;
  std::uint64_t full = 0;            ///< `send` found no room
  std::uint64_t refused = 0;         ///< `send` refused
  std::uint64_t overrun = 0;         ///< frames lost on arrival, for want of room in adapter or kernel
  std::uint64_t malformed = 0;       ///< arrived and were no frames
  std::uint64_t error_reports = 0;   ///< by the controller: error frames, error messages of an adapter
  std::uint64_t no_acknowledge = 0;  ///< of them: frames without acknowledgement
  std::uint64_t send_timeouts = 0;   ///< of them: the controller could not send in time
  std::uint64_t send_failures = 0;   ///< an adapter said that it did not take a frame
  std::uint64_t bus_offs = 0;        ///< times that the state became BusOff
  std::uint64_t downs = 0;           ///< times that it became Down or Gone
  std::uint64_t restarts = 0;        ///< times that frames could pass again
  std::uint64_t failed_calls = 0;    ///< system calls that failed in other ways
};

/// A bus as one participant sees it. Own frames do not come back.
class CanLink {
 public:
  virtual ~CanLink() = default;

  virtual Sent send(const CanFrame& frame) noexcept = 0;
  /// The oldest frame that has arrived. False when there is none.
  virtual bool receive(CanFrame& frame) noexcept = 0;
  /// Waits until something can be received or the state changes, at most `timeout_ns`. True when a `receive` is worth
  /// while.
  virtual bool wait(hal::TimeNs timeout_ns) noexcept = 0;
  /// What `poll` can wait on for input, for those who must not hold the link while they wait; -1: there is none.
  virtual int descriptor() const noexcept { return -1; }
  /// As of the last call to another function.
  virtual BusState state() const noexcept = 0;
  virtual CanStatistics statistics() const noexcept = 0;
  /// For messages: "can:can0".
  virtual std::string name() const = 0;
};

/// Opens a link, or reopens it when it is Gone. May block for seconds: call it from a worker thread.
using CanOpener = std::function<hal::Result<std::unique_ptr<CanLink>>()>;

/// The state of a bus with the counting of its changes; what every link holds.
class BusRecord {
 public:
  BusState state() const noexcept { return state_; }
  /// Counts bus-offs, downs and restarts. From Gone nothing leads back.
  void become(BusState state) noexcept;

  CanStatistics counts;

 private:
  BusState state_ = BusState::Active;
};

}  // namespace tandem::bridges
