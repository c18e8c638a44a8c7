// Flight of a quadrotor: where it is to go, or how fast, and where it is.
//
// A robot that takes both commands flies to the position while that is not on hold, else with the speed.
#pragma once
#include <array>

#include "hal/port.hpp"

namespace tandem::hal {

/// A place to fly to and to stay at, with a heading. Safe value: on hold, which is to hover.
struct QuadrotorPosition : Command {
  static constexpr std::string_view kName = "quadrotor_position";
  static constexpr std::string_view kDoc = "Place and heading to fly to.";

  bool hold = true;                ///< hover where it is; the target does not count
  std::array<double, 3> target{};  ///< of the body's base; in W, m
  double yaw_rad = 0.0;            ///< heading in W

  void set(double x_m, double y_m, double z_m, double yaw) noexcept {
    hold = false;
    target = {x_m, y_m, z_m};
    yaw_rad = yaw;
  }
  void hover() noexcept { hold = true; }
  void describe(FieldList& f) const {
    f.add("hold", hold, unit::none, Frame::None, Fusion::Real, "hover; the target does not count");
    f.add("target", target, unit::m, Frame::World, Fusion::Real, "place of the body's base");
    f.add("yaw", yaw_rad, unit::rad, Frame::World, Fusion::Real, "heading, counter-clockwise from x");
  }
};

/// Velocity and turn rate. Safe value: 0, which is to hover.
struct QuadrotorSpeed : Command {
  static constexpr std::string_view kName = "quadrotor_speed";
  static constexpr std::string_view kDoc = "Velocity and turn rate to fly with.";

  std::array<double, 3> velocity{};  ///< in W, m/s
  double yaw_rad_s = 0.0;            ///< counter-clockwise seen from above

  void set(double x_m_s, double y_m_s, double z_m_s, double turn_rad_s) noexcept {
    velocity = {x_m_s, y_m_s, z_m_s};
    yaw_rad_s = turn_rad_s;
  }
  void describe(FieldList& f) const {
    f.add("velocity", velocity, unit::m_s, Frame::World, Fusion::Real, "velocity of the body");
    f.add("yaw_rate", yaw_rad_s, unit::rad_s, Frame::World, Fusion::Real, "turn rate, counter-clockwise from above");
  }
};

/// Where the robot is, as a positioning system tells it.
struct Positioning : Reading {
  static constexpr std::string_view kName = "positioning";
  static constexpr std::string_view kDoc = "Place and orientation of the body in the world.";

  std::array<double, 3> p_WB{};                       ///< of the body's base, m
  std::array<double, 4> q_WB = {1.0, 0.0, 0.0, 0.0};  ///< w, x, y, z: turns body vectors into W

  void describe(FieldList& f) const {
    f.add("position", p_WB, unit::m, Frame::World, Fusion::Real, "place of the body's base");
    f.add("orientation", q_WB, unit::none, Frame::World, Fusion::Real, "quaternion w, x, y, z from body to world");
  }
};

}  // namespace tandem::hal
