// Estimates another clock (of a robot, of a tracker) from the stamps of its messages: no clock needs to be set right.
#pragma once
#include <array>
#include <cstddef>
#include <cstdint>
#include <optional>

#include "hal/time.hpp"

namespace tandem::bridges {

/// What is known of another clock. Counted from the start.
struct ClockState {
  hal::TimeNs offset_ns = 0;            ///< our clock minus the other one, now
  double drift_ppm = 0.0;               ///< by which that grows: the other clock is slow
  double drift_bound_ppm = 0.0;         ///< how far `drift_ppm` may be off
  std::optional<hal::TimeNs> bound_ns;  ///< of the error of `offset_ns`, by exchanges; nothing: only one way is known
  std::uint64_t messages = 0;           ///< with a stamp
  std::uint64_t exchanges = 0;          ///< of these, that answered something
  std::uint64_t jumps = 0;              ///< the clock was set
  std::uint64_t shifts = 0;             ///< set by less than a second, or the way is longer or shorter for good
  std::uint64_t implausible = 0;        ///< stamps that no clock shows
};

/// Offset, drift and their bounds. `stamp_ns` is by the other clock, all other times by ours.
///
/// A message cannot come before it was sent, so (received - stamp) bounds the offset from above, and the least says
/// most; an answer cannot be sent before its question, which bounds it from below. The best bounds of each of the last
/// kBins times kBin are kept: the drift is the slope of the lower convex hull of the upper ones [Moon, Skelly, Towsley
/// 1999], as far as a line with that slope has room between upper and lower ones. Where answers come the estimate is
/// the middle between both bounds, and half of what is between them bounds its error; without answers it is late by the
/// shortest way.
///
/// A clock that was set by more than a second, or so that messages come before they were sent, is noticed after five
/// messages that came over 50 ms or more, and followed; until then what it stamps looks old, or as if taken when it
/// came. One message with a stamp of the future changes nothing. What comes at once after we were asleep is old, and no
/// clock that was set. An answer whose stamp lies before its question proves that the clock was set back. Without
/// answers a clock set by less than a second and a way that is longer look alike: after 5 to 10 s in which no message
/// was as quick as before the estimate starts again. Allocates nothing. Not thread-safe.
class ClockEstimator {
 public:
  static constexpr hal::TimeNs kBin = 5 * hal::kNsPerSecond;
  static constexpr std::size_t kBins = 48;
  static constexpr std::int64_t kLatest = 3'786'912'000'000'000'000;  ///< the year 2090

  /// A message came. Stamps that no clock shows, before 1970 or after 2090, are counted and left out.
  void note(std::int64_t stamp_ns, hal::TimeNs received_ns) noexcept;
  /// And it answered what was sent at `sent_ns`.
  void note_answer(std::int64_t stamp_ns, hal::TimeNs sent_ns, hal::TimeNs received_ns) noexcept;

  /// Whether a clock may show that: dates from 1970 to 2090, and time since a start.
  static constexpr bool plausible(std::int64_t stamp_ns) noexcept { return stamp_ns >= 0 && stamp_ns <= kLatest; }
  /// A stamp in microseconds, as this takes it; implausible ones stay so.
  static std::int64_t from_us(std::int64_t stamp_us) noexcept;

  /// When, on our clock, the other one showed `stamp_ns`; never after `received_ns`, which is also the answer when
  /// nothing is known.
  hal::TimeNs local(std::int64_t stamp_ns, hal::TimeNs received_ns) const noexcept;

  /// Messages have come late one after the other: the way is longer now, or the clock was set back by less than a
  /// second. An answer tells which.
  bool doubtful() const noexcept { return late_in_row_ >= kDoubtAfter; }
  bool known() const noexcept { return count_ > 0; }
  hal::TimeNs offset_ns(hal::TimeNs at_ns) const noexcept;
  std::uint64_t jumps() const noexcept { return jumps_; }
  ClockState state(hal::TimeNs at_ns) const noexcept;

 private:
  /// The best bounds of the offset in one stretch, ns from `origin_ns_`, and when they were found, s from `begin_ns_`.
  struct Bin {
    double above_at_s = 0.0, above = 0.0;
    double below_at_s = 0.0, below = 0.0;
    bool answered = false;
  };
  /// What bounds say at a moment: the value of the best one, and as wrong as the drift may be.
  struct Bounds {
    double above = 0.0, above_most = 0.0;
    double below = 0.0, below_least = 0.0;
    bool answered = false;
  };
  Bin& bin(std::size_t i) noexcept { return bins_[(first_ + i) % kBins]; }
  const Bin& bin(std::size_t i) const noexcept { return bins_[(first_ + i) % kBins]; }
  void begin(hal::TimeNs difference, hal::TimeNs received_ns) noexcept;
  void note_early(hal::TimeNs difference, hal::TimeNs received_ns, bool set) noexcept;
  void note_odd(hal::TimeNs difference, hal::TimeNs received_ns) noexcept;
  void next_bin(double difference, hal::TimeNs received_ns) noexcept;
  void learn_drift() noexcept;
  double hull_slope(double& spread) const noexcept;
  Bounds bounds(double at_s) const noexcept;
  double seconds(hal::TimeNs at_ns) const noexcept { return hal::to_seconds(at_ns - begin_ns_); }
  double relative(hal::TimeNs offset_ns) const noexcept { return static_cast<double>(offset_ns - origin_ns_); }

  static constexpr unsigned kDoubtAfter = 10;
  static constexpr double kUnknownDrift = 500e3;  // ns/s: two crystals, generously

  std::array<Bin, kBins> bins_{};
  std::size_t first_ = 0, count_ = 0;
  hal::TimeNs begin_ns_ = 0, origin_ns_ = 0;
  hal::TimeNs bin_start_ns_ = 0;
  double drift_ = 0.0, doubt_ = kUnknownDrift;  // ns/s
  unsigned high_bins_ = 0;                      // in a row, in which no message was as quick as before
  unsigned late_in_row_ = 0;
  unsigned odd_in_row_ = 0;  // messages that say the clock was set
  hal::TimeNs odd_least_ = 0, odd_since_ns_ = 0;
  unsigned early_ = 0, early_set_ = 0;  // messages earlier than the quickest; of these, before they were sent
  hal::TimeNs early_least_ = 0, early_since_ns_ = 0, early_last_ns_ = 0;
  std::uint64_t messages_ = 0, exchanges_ = 0, jumps_ = 0, shifts_ = 0, implausible_ = 0;
};

}  // namespace tandem::bridges
