// Limits of commands. Every command, also one that makes no sense, is made safe before a robot gets it; those that move
// a real robot are also held back while it gets under way again, and kept inside the arena.
//
//   using LimitedBy = TurretPart;                         a part of the robot, its locomotion, or RobotKind
//   Limited limit(const LimitedBy&)                       what that allows; every actuator has it
//   void slow_down(double most_m_s, const Pose* at)       actuators that move the robot have these three
//   bool keep_inside(const Fence&, const Pose& at, double look_ahead_s)
//   bool keep_out(const Pose& at, double out_x, double out_y)
#pragma once
#include <algorithm>
#include <cmath>
#include <cstdint>
#include <limits>

#include "hal/pose.hpp"

namespace tandem::hal {

enum class LimitResult : std::uint8_t { Passed, Clamped, NotFinite };

/// Result of limiting a command.
struct Limited {
  LimitResult result = LimitResult::Passed;
  /// Of a speed that was clamped: what was asked for and the most that there is; 0: it is no such speed.
  double asked_m_s = 0.0, most_m_s = 0.0;
};

inline constexpr Limited kPassed{};
inline constexpr Limited kClamped{LimitResult::Clamped};
inline constexpr Limited kNotFinite{LimitResult::NotFinite};

/// A box in W, in metres, from the ground up to its ceiling: the edge of the arena, for robots that no simulated wall
/// can hold.
struct Fence {
  double min_x_m = 0.0, min_y_m = 0.0, max_x_m = 0.0, max_y_m = 0.0;
  double max_z_m = std::numeric_limits<double>::infinity();

  bool contains(const Pose& pose) const noexcept {
    return pose.x_m >= min_x_m && pose.x_m <= max_x_m && pose.y_m >= min_y_m && pose.y_m <= max_y_m &&
           pose.z_m <= max_z_m;
  }
  Pose clamped(Pose pose) const noexcept {
    pose.x_m = std::clamp(pose.x_m, min_x_m, max_x_m);
    pose.y_m = std::clamp(pose.y_m, min_y_m, max_y_m);
    pose.z_m = std::min(pose.z_m, max_z_m);
    return pose;
  }
  /// Where the middle of a body's base may be so that all of the body is inside. A body that is wider than the fence
  /// belongs into its middle; one that is higher, on the ground.
  Fence for_body(double radius_m, double height_m) const noexcept {
    Fence inner = *this;
    narrow(inner.min_x_m, inner.max_x_m, radius_m);
    narrow(inner.min_y_m, inner.max_y_m, radius_m);
    inner.max_z_m = std::max(0.0, max_z_m - height_m);
    return inner;
  }
  /// Whether a step along an axis leads over the bound, or further beyond it.
  static bool leads_out(double at, double step, double min, double max) noexcept {
    return (step > 0.0 && at + step > max) || (step < 0.0 && at + step < min);
  }

 private:
  /// An interval without `margin` at either side; where nothing is left, its middle.
  static void narrow(double& min, double& max, double margin) noexcept {
    min += margin;
    max -= margin;
    if (min > max) min = max = 0.5 * (min + max);
  }
};

/// For what turns about the robot's axis, turret and distance scanner: speeds are clamped; a command that is not
/// finite, or of no known mode, becomes the safe one.
template <class Drive, class Mode>
Limited limit_turn(Drive& command, Mode last_mode, double most_rad_s) noexcept {
  if (!std::isfinite(command.speed_rad_s) || !std::isfinite(command.angle_rad) || command.mode > last_mode) {
    command = Drive{};
    return kNotFinite;
  }
  if (std::fabs(command.speed_rad_s) <= most_rad_s) return kPassed;
  command.speed_rad_s = std::clamp(command.speed_rad_s, -most_rad_s, most_rad_s);
  return kClamped;
}

}  // namespace tandem::hal
