// Differential drive: the command for two wheels, and what their encoders counted and make of it.
#pragma once
#include <algorithm>
#include <cmath>

#include "hal/port.hpp"

namespace tandem::hal {

/// Speeds of the two wheels at the rim. Safe value: both 0.
struct WheelSpeeds : Command {
  static constexpr std::string_view kName = "differential_steering";
  static constexpr std::string_view kDoc = "Speeds of the left and right wheel.";

  double left_m_s = 0.0;
  double right_m_s = 0.0;

  void set(double left, double right) noexcept {
    left_m_s = left;
    right_m_s = right;
  }
  /// Speeds beyond the limit are clamped, both by the same factor so that the curve driven stays the same; a command
  /// that is not finite becomes the safe one.
  Limited limit_to(double most_m_s) noexcept {
    const double left = std::fabs(left_m_s);
    const double right = std::fabs(right_m_s);
    if (left <= most_m_s && right <= most_m_s) return kPassed;  // false when either is NaN
    if (!std::isfinite(left) || !std::isfinite(right)) {
      *this = {};
      return kNotFinite;
    }
    const double fastest = std::max(left, right);
    const double scale = most_m_s / fastest;
    left_m_s *= scale;
    right_m_s *= scale;
    return {LimitResult::Clamped, fastest, most_m_s};
  }
  using LimitedBy = DifferentialDrive;
  Limited limit(const DifferentialDrive& drive) noexcept { return limit_to(drive.max_speed_m_s); }

  /// What is no finite number stays: `limit` comes afterwards, and counts it.
  void slow_down(double most_m_s, const Pose*) noexcept {
    if (std::isfinite(left_m_s) && std::isfinite(right_m_s)) limit_to(most_m_s);
  }
  /// The robot may turn wherever it is, but drive only where it stays inside, or comes back in: else both wheels lose
  /// what they have in common.
  bool keep_inside(const Fence& fence, const Pose& at, double look_ahead_s) noexcept {
    const double step_m = forward_m_s() * look_ahead_s;
    if (!Fence::leads_out(at.x_m, step_m * at.cos_h, fence.min_x_m, fence.max_x_m) &&
        !Fence::leads_out(at.y_m, step_m * at.sin_h, fence.min_y_m, fence.max_y_m)) {
      return false;
    }
    stay();
    return true;
  }
  bool keep_out(const Pose& at, double out_x, double out_y) noexcept {
    if (forward_m_s() * (at.cos_h * out_x + at.sin_h * out_y) >= 0.0) return false;
    stay();
    return true;
  }
  double forward_m_s() const noexcept { return 0.5 * (left_m_s + right_m_s); }
  /// What is left turns the robot on the spot.
  void stay() noexcept {
    const double forward = forward_m_s();
    left_m_s -= forward;
    right_m_s -= forward;
  }
  void describe(FieldList& f) const {
    f.add("left", left_m_s, unit::m_s, Frame::Body, Fusion::Real, "rim speed of the left wheel, forward positive");
    f.add("right", right_m_s, unit::m_s, Frame::Body, Fusion::Real, "rim speed of the right wheel, forward positive");
  }
};

/// Distance that each wheel has rolled since the start of the run (forward positive), and its speed over the last tick.
/// On an e-puck the encoders count commanded steps of a stepper motor: they say nothing about slip.
struct WheelEncoders : Reading {
  static constexpr std::string_view kName = "wheel_encoders";
  static constexpr std::string_view kDoc =
      "Distance rolled by each wheel since the start, and speed over the last tick.";

  double left_m = 0.0;
  double right_m = 0.0;
  float left_m_s = 0.0F;
  float right_m_s = 0.0F;

  void describe(FieldList& f) const {
    f.add("left", left_m, unit::m, Frame::None, Fusion::Real, "distance rolled by the left wheel");
    f.add("right", right_m, unit::m, Frame::None, Fusion::Real, "distance rolled by the right wheel");
    f.add("left_speed", left_m_s, unit::m_s, Frame::None, Fusion::Real, "mean speed over the last tick");
    f.add("right_speed", right_m_s, unit::m_s, Frame::None, Fusion::Real, "mean speed over the last tick");
  }
};

/// Odometry: pose by the wheels' encoders, relative to that at the start: x forward, y left of how it
/// stood then. Errors add up: it knows of no slip.
struct Odometry : Reading {
  static constexpr std::string_view kName = "odometry";
  static constexpr std::string_view kDoc =
      "Place and heading relative to the start, reckoned from the wheels' encoders.";

  double x_m = 0.0;
  double y_m = 0.0;
  double heading_rad = 0.0;  ///< in (-pi, pi], counter-clockwise

  void describe(FieldList& f) const {
    f.add("x", x_m, unit::m, Frame::None, Fusion::Real, "forward of the start");
    f.add("y", y_m, unit::m, Frame::None, Fusion::Real, "left of the start");
    f.add("heading", heading_rad, unit::rad, Frame::None, Fusion::Real, "counter-clockwise from that at the start");
  }
};

}  // namespace tandem::hal
