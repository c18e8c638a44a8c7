// Lateness of our own thread: time-outs of others must not count it.
#pragma once
#include <algorithm>

#include "hal/time.hpp"

namespace tandem::bridges {

/// Told of every turn of a thread that promised to take one every `kPromised`, says how much later it came, and how
/// late it was at worst of late: what a machine does to us it does to robots that are emulated on it, and to its links.
/// Not thread-safe.
class StallMeter {
 public:
  static constexpr hal::TimeNs kPromised = 20 * hal::kNsPerMs;
  static constexpr hal::TimeNs kNoticed = 20 * hal::kNsPerMs;  ///< less is no stall
  static constexpr hal::TimeNs kMost = hal::kNsPerSecond;      ///< a longer one is a freeze: nothing of it is excused
  static constexpr hal::TimeNs kMostPatience = 250 * hal::kNsPerMs;
  static constexpr hal::TimeNs kWindow = 10 * hal::kNsPerSecond;

  /// A turn at `now`. @returns by how much it came too late; 0: it did not, or by more than `kMost`.
  hal::TimeNs turn(hal::TimeNs now) noexcept {
    const hal::TimeNs late = begun_ ? now - last_ns_ - kPromised : 0;
    begun_ = true;
    last_ns_ = std::max(last_ns_, now);
    if (now - window_ns_ >= kWindow) {
      worst_before_ns_ = now - window_ns_ >= 2 * kWindow ? 0 : worst_ns_;
      worst_ns_ = 0;
      window_ns_ = now;
    }
    if (late < kNoticed) return 0;
    worst_ns_ = std::max(worst_ns_, late);
    if (late > kMost) return 0;
    stall_ns_ = late;
    excused_until_ns_ = now + kExcused;
    return stall_ns_;
  }
  /// To be added to every time-out at `now`: what just was our own fault, else what the machine did in the last 10 to
  /// 20 s.
  hal::TimeNs patience_ns(hal::TimeNs now) const noexcept {
    const hal::TimeNs usual = std::min(std::max(worst_ns_, worst_before_ns_), kMostPatience);
    return now < excused_until_ns_ ? std::max(stall_ns_, usual) : usual;
  }

 private:
  static constexpr hal::TimeNs kExcused = 300 * hal::kNsPerMs;  // until what waited has come in

  bool begun_ = false;
  hal::TimeNs last_ns_ = 0, window_ns_ = 0;
  hal::TimeNs worst_ns_ = 0, worst_before_ns_ = 0;  // in this window and the one before
  hal::TimeNs stall_ns_ = 0, excused_until_ns_ = 0;
};

}  // namespace tandem::bridges
