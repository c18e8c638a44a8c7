// Estimates the offset of the robot's clock from the stamps of its messages: no clock needs to be set right.
#pragma once
#include <cstdint>

#include "hal/time.hpp"

namespace tandem::bridges::eyebot {

/// Our clock minus the robot's. A message cannot come before it was sent, so the least of (received - stamp) bounds the
/// offset from above; an answer cannot be sent before the question, which bounds it from below. Minima are kept for 5
/// to 10 s, so that a drift is followed. A clock that was set by more than a second is noticed after five messages that
/// came over 50 ms or more, and followed; until then what it stamps looks old, or as if taken when it came. One message
/// with a stamp of the future changes nothing. What comes at once after we were asleep is old, and no clock that was
/// set. An answer whose stamp lies before its question proves that the clock was set back, by however little.
/// Not thread-safe.
class ClockOffset {
 public:
  /// A message stamped `utime` (microseconds, the robot's clock) came at `received_ns` (ours). Stamps that no clock
  /// shows, before 1970 or after 2090, are counted and left out.
  void note(std::int64_t utime, hal::TimeNs received_ns) noexcept;
  /// And it answered what was sent at `sent_ns`.
  void note_answer(std::int64_t utime, hal::TimeNs sent_ns, hal::TimeNs received_ns) noexcept;

  /// When, on our clock, the robot's showed `utime`; never after `received_ns`, which is also the answer when nothing
  /// is known.
  hal::TimeNs local(std::int64_t utime, hal::TimeNs received_ns) const noexcept;

  /// Messages have come late one after the other: the way is longer now, or the clock was set back by less than a
  /// second. An answer tells which.
  bool doubtful() const noexcept { return late_in_row_ >= kDoubtAfter; }
  bool known() const noexcept { return known_; }
  hal::TimeNs offset_ns() const noexcept;
  std::uint64_t jumps() const noexcept { return jumps_; }
  std::uint64_t implausible() const noexcept { return implausible_; }

 private:
  void begin(hal::TimeNs least, hal::TimeNs received_ns) noexcept;
  void note_odd(hal::TimeNs difference, hal::TimeNs received_ns) noexcept;

  bool known_ = false;
  hal::TimeNs least_ = 0, least_before_ = 0;  // in this window and the one before
  hal::TimeNs window_start_ns_ = 0;
  bool bounded_ = false;
  hal::TimeNs below_ = 0, below_at_ns_ = 0;
  static constexpr unsigned kDoubtAfter = 10;
  unsigned late_in_row_ = 0;
  unsigned odd_in_row_ = 0;  // messages that say the clock was set
  hal::TimeNs odd_least_ = 0, odd_since_ns_ = 0;
  std::uint64_t jumps_ = 0, implausible_ = 0;
};

}  // namespace tandem::bridges::eyebot
