// The edge of the arena, for robots that no simulated wall can hold.
#pragma once
#include <algorithm>

#include "core/space/pose.hpp"
#include "hal/device/flight.hpp"
#include "hal/device/wheels.hpp"

namespace tandem::mixed_reality {

/// A rectangle in W, in metres.
struct Fence {
  double min_x_m = 0.0, min_y_m = 0.0, max_x_m = 0.0, max_y_m = 0.0;

  bool contains(const core::Pose& pose) const noexcept {
    return pose.x_m >= min_x_m && pose.x_m <= max_x_m && pose.y_m >= min_y_m && pose.y_m <= max_y_m;
  }
  core::Pose clamped(core::Pose pose) const noexcept {
    pose.x_m = std::clamp(pose.x_m, min_x_m, max_x_m);
    pose.y_m = std::clamp(pose.y_m, min_y_m, max_y_m);
    return pose;
  }
};

/// Lets a robot at `pose` turn wherever it is, but drive only where it stays inside for `look_ahead_s`, or comes back
/// in: else both wheels lose what they have in common. @returns whether anything was taken away.
bool keep_inside(const Fence& fence, const core::Pose& pose, double look_ahead_s, hal::WheelSpeeds& wheels) noexcept;

/// The same for a robot that flies: it loses the part of its velocity that leads out.
bool keep_inside(const Fence& fence, const core::Pose& pose, double look_ahead_s, hal::QuadrotorSpeed& speed) noexcept;
/// A target outside becomes the nearest inside.
bool keep_inside(const Fence& fence, hal::QuadrotorPosition& target) noexcept;

}  // namespace tandem::mixed_reality
