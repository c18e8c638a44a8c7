// Delays of emulated robots, each by itself: the link's two ways, the motors, the counters of the wheels.
#pragma once
#include <cmath>
#include <deque>
#include <optional>
#include <utility>

#include "hal/params.hpp"
#include "hal/time.hpp"

namespace tandem::bridges {

/// Where time passes between a command and what a host reads of it. All are 0 where nothing is said.
///
///   host --to_robot--> firmware --command--> motors --body--> body (its place, its gyroscope)
///   host <--to_host--- firmware <------------counters (as the motors were `counters` ago)
struct Delays {
  double to_robot_s = 0.0;  ///< on the link, beside what bytes take
  double to_host_s = 0.0;   ///< the same, of what the robot says
  double command_s = 0.0;   ///< from when the firmware has taken a speed until the motors turn by it
  double counters_s = 0.0;  ///< what is read of the wheels' counters (of an eye-bot: of its place) is so old
  double body_s = 0.0;      ///< the body is later than its motors; for bodies that do not lag by themselves

  void describe(hal::ParamVisitor& v) {
    v.number("to_robot_delay", to_robot_s, hal::unit::s, {0.0, 2.0}, "Of its link, from the host to the robot.");
    v.number("to_host_delay", to_host_s, hal::unit::s, {0.0, 2.0}, "Of its link, from the robot to the host.");
    v.number("command_delay", command_s, hal::unit::s, {0.0, 2.0},
             "From when the robot has a speed until its motors turn by it.");
    v.number("counter_delay", counters_s, hal::unit::s, {0.0, 2.0},
             "By which the counters of its wheels (an eye-bot: its place) are older than their reading.");
  }
};

inline hal::TimeNs delay_ns(double delay_s) noexcept {
  return static_cast<hal::TimeNs>(std::llround(delay_s * 1e9));
}

/// Values that take effect a fixed time after they were said, in their order.
template <class T>
class DelayLine {
 public:
  explicit DelayLine(double delay_s) noexcept : delay_ns_(delay_ns(delay_s)) {}

  void put(hal::TimeNs at, T value) { waiting_.emplace_back(at + delay_ns_, std::move(value)); }
  /// Calls `use(at, value)` for each that takes effect by `now`.
  template <class Use>
  void take(hal::TimeNs now, Use&& use) {
    while (!waiting_.empty() && waiting_.front().first <= now) {
      const std::pair<hal::TimeNs, T> next = std::move(waiting_.front());
      waiting_.pop_front();
      use(next.first, next.second);
    }
  }
  /// When the next one does.
  std::optional<hal::TimeNs> next_at() const {
    return waiting_.empty() ? std::nullopt : std::optional(waiting_.front().first);
  }
  void clear() noexcept { waiting_.clear(); }

 private:
  hal::TimeNs delay_ns_;
  std::deque<std::pair<hal::TimeNs, T>> waiting_;
};

}  // namespace tandem::bridges
