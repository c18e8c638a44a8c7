// True poses of emulated robots' bodies: rolled on, and written to logs, which emulated trackers read.
#pragma once
#include <algorithm>
#include <cmath>

#include "bridges/body_pose.hpp"
#include "bridges/emulation/event_log.hpp"
#include "bridges/emulation/fault_spec.hpp"
#include "hal/angle.hpp"
#include "hal/params.hpp"

namespace tandem::bridges {

/// The pose after both wheels have rolled so far, without slip: the chord of the arc that the centre drives [Siegwart
/// 2011, section 3.2].
inline BodyPose rolled(const BodyPose& pose, double left_m, double right_m, double wheel_base_m) noexcept {
  const double turn_rad = (right_m - left_m) / wheel_base_m;
  const double half = 0.5 * turn_rad;
  const double chord_m = 0.5 * (left_m + right_m) * (std::fabs(half) < 1e-9 ? 1.0 : std::sin(half) / half);
  return {pose.x_m + chord_m * std::cos(pose.heading_rad + half),
          pose.y_m + chord_m * std::sin(pose.heading_rad + half), hal::wrapped(pose.heading_rad + turn_rad)};
}

/// Options of an emulator whose log may tell its body's true pose.
struct PoseOptions {
  BodyPose start{};       ///< of a body of its own
  double poses_hz = 0.0;  ///< how often the log tells its pose; 0: never
  void describe(hal::ParamVisitor& v) {
    v.number("x", start.x_m, hal::unit::m, hal::kAny, "Where its body starts, without --arena.");
    v.number("y", start.y_m, hal::unit::m, hal::kAny, "The same.");
    v.number("heading", start.heading_rad, hal::unit::deg, hal::kAny, "The same, counter-clockwise from x.");
    v.number(
        "poses", poses_hz, hal::unit::none, {0.0, 1000.0},
        "How often a second the log tells its true pose, for emulated trackers; in an arena, at most once a tick.");
  }
};

/// When a true pose is told, and how: the event `pose` with x_m, y_m, heading_rad and taken_t_ns.
class PoseTeller {
 public:
  explicit PoseTeller(double poses_hz) noexcept
      : period_ns_(poses_hz > 0.0 ? static_cast<hal::TimeNs>(1e9 / poses_hz) : 0) {}

  hal::TimeNs due() const noexcept { return period_ns_ > 0 ? next_ : kEndless; }
  /// Asks `pose_at(now)`, a std::optional<BodyPose>, if it is due, and hands a new pose to `tell(now, event, fields)`.
  template <class PoseAt, class Tell>
  void turn(hal::TimeNs now, const PoseAt& pose_at, const Tell& tell) {
    if (now < due()) return;
    next_ = std::max(next_ + period_ns_, now);
    const auto pose = pose_at(now);
    if (!pose || pose->taken_ns == told_ns_) return;
    told_ns_ = pose->taken_ns;
    tell(now, "pose",
         EventFields{{"x_m", pose->x_m},
                     {"y_m", pose->y_m},
                     {"heading_rad", pose->heading_rad},
                     {"taken_t_ns", pose->taken_ns}});
  }

 private:
  hal::TimeNs period_ns_, next_ = 0, told_ns_ = -1;
};

}  // namespace tandem::bridges
