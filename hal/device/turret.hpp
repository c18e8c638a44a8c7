// A turret: a ring that turns about the robot's vertical axis and carries its gripper and LEDs.
#pragma once
#include <string>

#include "hal/port.hpp"

namespace tandem::hal {

/// The turret and its motor.
struct TurretPart {
  static constexpr std::string_view kName = "turret";
  static constexpr std::string_view kDoc = "A ring that turns about the robot's axis and carries its gripper and LEDs.";
  double turn_rad_s = 0.0;  ///< fastest turn
  double torque_Nm = 0.0;   ///< that its motor turns a load with
  std::string source = {};

  void describe(ParamVisitor& v) {
    v.number("turn", turn_rad_s, unit::rad_s, {1e-9, 1e4}, "Fastest turn.");
    v.number("torque", torque_Nm, unit::none, kNotNegative, "In Nm, that its motor turns a load with.");
    v.text("source", source, "Where these figures come from.");
  }
  void appear(const RobotKind&, Appearance& look) const {
    look.joints.push_back({.name = "turret", .by = {"turret", "angle"}});
    look.upper = "turret";
  }
};

/// Drive mode of a turret. The numbers are part of the port.
enum class TurretMode : std::uint8_t {
  Off = 0,      ///< nothing does: it stays where it is on the body
  Passive = 1,  ///< whatever the gripper holds: the body turns freely beneath it
  Speed = 2,    ///< its motor, with `speed_rad_s`
  Position = 3  ///< its motor, to `angle_rad` by the shorter way
};

/// Command of the turret. Angles are relative to the body, counter-clockwise from forward. Safe value: off.
struct TurretDrive : Command {
  static constexpr std::string_view kName = "turret";
  static constexpr std::string_view kDoc = "What the turret is to do: off, passive, turn, or go to an angle.";

  TurretMode mode = TurretMode::Off;
  double speed_rad_s = 0.0;  ///< in mode Speed
  double angle_rad = 0.0;    ///< in mode Position

  void turn_off() noexcept { *this = {}; }
  void let_go() noexcept { mode = TurretMode::Passive; }
  void turn(double rad_s) noexcept {
    mode = TurretMode::Speed;
    speed_rad_s = rad_s;
  }
  void go_to(double rad) noexcept {
    mode = TurretMode::Position;
    angle_rad = rad;
  }
  using LimitedBy = TurretPart;
  Limited limit(const TurretPart& turret) noexcept {
    return limit_turn(*this, TurretMode::Position, turret.turn_rad_s);
  }
  void describe(FieldList& f) const {
    f.add("mode", mode, unit::none, Frame::None, Fusion::Real, "0 off, 1 passive, 2 speed, 3 position");
    f.add("speed", speed_rad_s, unit::rad_s, Frame::Body, Fusion::Real, "turn rate, counter-clockwise from above");
    f.add("angle", angle_rad, unit::rad, Frame::Body, Fusion::Real, "where to turn to, counter-clockwise from forward");
  }
};

/// Angle of the turret.
struct TurretEncoder : Reading {
  static constexpr std::string_view kName = "turret_encoder";
  static constexpr std::string_view kDoc = "Angle of the turret on the body.";

  double angle_rad = 0.0;    ///< in (-pi, pi], counter-clockwise from forward
  float speed_rad_s = 0.0F;  ///< mean over the last tick

  void describe(FieldList& f) const {
    f.add("angle", angle_rad, unit::rad, Frame::Body, Fusion::Real, "counter-clockwise from forward");
    f.add("speed", speed_rad_s, unit::rad_s, Frame::Body, Fusion::Real, "mean turn rate over the last tick");
  }
};

}  // namespace tandem::hal
