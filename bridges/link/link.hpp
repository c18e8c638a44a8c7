// Byte links: carriers of a robot's bytes of any make.
//
// One thread reads (`wait`, `read`) while another may write; nothing else is shared. No call blocks longer than it
// says.
#pragma once
#include <cstddef>
#include <cstdint>
#include <functional>
#include <memory>
#include <span>
#include <string>

#include "hal/result.hpp"
#include "hal/time.hpp"

namespace tandem::bridges {

/// HungUp: the other side is gone (cable out, Bluetooth out of range). A serial link never recovers from it and must be
/// reopened; links that lose their peer for a while only (`FaultyLink`) become Open again by themselves.
enum class LinkState : std::uint8_t { Open, HungUp };

/// Counted since the link was made.
struct LinkStatistics {
  std::uint64_t bytes_in = 0;
  std::uint64_t bytes_out = 0;
  std::uint64_t bytes_refused = 0;  ///< could not be written in the time allowed, or after a hang-up
  std::uint64_t errors = 0;         ///< failed system calls, hang-ups
};

/// What one `read` gave: the first `size` bytes of the buffer, all stamped with the time of their arrival.
struct Received {
  std::size_t size = 0;
  hal::TimeNs at_ns = 0;  ///< on the link's clock: CLOCK_MONOTONIC unless another was given
};

/// A two-way stream of bytes.
class ByteLink {
 public:
  virtual ~ByteLink() = default;

  /// Writes all of `bytes`, or as many as the link takes within `budget_ns` (0: what goes at once). Returns how many
  /// were taken; the rest is lost and counted as refused.
  virtual std::size_t write(std::span<const std::uint8_t> bytes, hal::TimeNs budget_ns) noexcept = 0;

  /// Takes bytes that have arrived, oldest first, without waiting. Bytes of one call share a stamp.
  virtual Received read(std::span<std::uint8_t> buffer) noexcept = 0;

  /// Waits until something can be read or the link hangs up, at most `timeout_ns`. True when a `read` is worth while.
  virtual bool wait(hal::TimeNs timeout_ns) noexcept = 0;

  /// What `poll` can wait on for input, for those who must not hold the link while they wait; -1: there is none.
  virtual int descriptor() const noexcept { return -1; }
  virtual LinkState state() const noexcept = 0;
  virtual LinkStatistics statistics() const noexcept = 0;
  /// For messages: "serial:/dev/ttyUSB0@115200".
  virtual std::string name() const = 0;
};

/// Opens a link, or reopens it after a hang-up. May block for seconds (Bluetooth): call it from a worker thread.
using LinkOpener = std::function<hal::Result<std::unique_ptr<ByteLink>>()>;

/// Source of time of a link that does not touch the outside world; tests give a clock that they turn by hand.
using Clock = std::function<hal::TimeNs()>;

/// CLOCK_MONOTONIC.
hal::TimeNs monotonic_ns() noexcept;

/// Waits until something can be read from `descriptor`, or shows that it has gone, at most `timeout_ns`; negative:
/// there is nothing to wait for, and a loop of waits must not spin.
bool wait_for_input(int descriptor, hal::TimeNs timeout_ns) noexcept;

}  // namespace tandem::bridges
