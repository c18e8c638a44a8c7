// Wheel commands as given, with their times: the input of a robot that obeys late.
#pragma once
#include <algorithm>
#include <array>
#include <cstddef>

#include "hal/time.hpp"

namespace tandem::mixed_reality {

/// From `at_ns` on, until the next.
struct WheelCommand {
  hal::TimeNs at_ns = 0;
  double left_m_s = 0.0, right_m_s = 0.0;
};

struct WheelWays {
  double left_m = 0.0, right_m = 0.0;
};

/// Calls `use(left_m_s, right_m_s, seconds)` for each stretch of one command in [from, until). `at(i)`: command `i` of
/// `count`, in the order of time. Before the first the robot stands.
template <class At, class Use>
void each_stretch(std::size_t count, const At& at, hal::TimeNs from, hal::TimeNs until, Use&& use) {
  std::size_t next = count;  // the first that begins after `from`
  for (std::size_t low = 0; low < next;) {
    const std::size_t middle = low + (next - low) / 2;
    if (at(middle).at_ns > from)
      next = middle;
    else
      low = middle + 1;
  }
  while (from < until) {
    const hal::TimeNs to = next < count ? std::min(until, at(next).at_ns) : until;
    if (to > from) {
      const double s = hal::to_seconds(to - from);
      next == 0 ? use(0.0, 0.0, s) : use(at(next - 1).left_m_s, at(next - 1).right_m_s, s);
    }
    from = to;
    ++next;
  }
}

/// The newest commands of one robot. Allocates nothing.
class CommandHistory {
 public:
  static constexpr std::size_t kKept = 128;

  /// Times never decrease.
  void note(const WheelCommand& command) noexcept {
    if (count_ > 0) {
      const WheelCommand& last = (*this)[count_ - 1];
      if (last.left_m_s == command.left_m_s && last.right_m_s == command.right_m_s) return;
    }
    if (count_ == kKept) {
      first_ = (first_ + 1) % kKept;
      --count_;
    }
    all_[(first_ + count_++) % kKept] = command;
  }
  std::size_t size() const noexcept { return count_; }
  const WheelCommand& operator[](std::size_t i) const noexcept { return all_[(first_ + i) % kKept]; }

  /// Stretches in [from, until), as `each_stretch`.
  template <class Use>
  void each(hal::TimeNs from, hal::TimeNs until, Use&& use) const {
    each_stretch(
        count_, [this](std::size_t i) -> const WheelCommand& { return (*this)[i]; }, from, until,
        std::forward<Use>(use));
  }
  /// What wheels roll that obey at once.
  WheelWays ways(hal::TimeNs from, hal::TimeNs until) const noexcept {
    WheelWays ways;
    each(from, until, [&ways](double left_m_s, double right_m_s, double s) {
      ways.left_m += left_m_s * s;
      ways.right_m += right_m_s * s;
    });
    return ways;
  }

 private:
  std::array<WheelCommand, kKept> all_;
  std::size_t first_ = 0, count_ = 0;
};

}  // namespace tandem::mixed_reality
