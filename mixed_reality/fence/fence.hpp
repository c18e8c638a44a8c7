// The edge of the arena, for robots that no simulated wall can hold.
#pragma once
#include <algorithm>
#include <limits>

#include "core/space/pose.hpp"
#include "hal/device/flight.hpp"
#include "hal/device/wheels.hpp"

namespace tandem::mixed_reality {

/// A box in W, in metres, from the ground up to its ceiling.
struct Fence {
  double min_x_m = 0.0, min_y_m = 0.0, max_x_m = 0.0, max_y_m = 0.0;
  double max_z_m = std::numeric_limits<double>::infinity();

  bool contains(const core::Pose& pose) const noexcept {
    return pose.x_m >= min_x_m && pose.x_m <= max_x_m && pose.y_m >= min_y_m && pose.y_m <= max_y_m &&
           pose.z_m <= max_z_m;
  }
  core::Pose clamped(core::Pose pose) const noexcept {
    pose.x_m = std::clamp(pose.x_m, min_x_m, max_x_m);
    pose.y_m = std::clamp(pose.y_m, min_y_m, max_y_m);
    pose.z_m = std::min(pose.z_m, max_z_m);
    return pose;
  }
  /// Where the middle of a body's base may be so that all of the body is inside. A body that is wider than the fence
  /// belongs into its middle; one that is higher, on the ground.
  Fence for_body(double radius_m, double height_m) const noexcept;
};

/// How fast a robot above the ceiling sinks.
inline constexpr double kSinkIntoFence_m_s = 0.2;

/// Lets a robot at `pose` turn wherever it is, but drive only where it stays inside for `look_ahead_s`, or comes back
/// in: else both wheels lose what they have in common. @returns whether anything was taken away.
bool keep_inside(const Fence& fence, const core::Pose& pose, double look_ahead_s, hal::WheelSpeeds& wheels) noexcept;

/// The same for a robot that flies: it loses the part of its velocity that leads out, and sinks while it is above the
/// ceiling, whatever was wanted. @returns whether anything was changed.
bool keep_inside(const Fence& fence, const core::Pose& pose, double look_ahead_s, hal::QuadrotorSpeed& speed) noexcept;
/// A target outside becomes the nearest inside. One that is on hold at a `pose` above the ceiling becomes the place
/// beneath it.
bool keep_inside(const Fence& fence, const core::Pose& pose, hal::QuadrotorPosition& target) noexcept;

}  // namespace tandem::mixed_reality
