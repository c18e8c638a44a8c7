// Flight of a quadrotor: where it is to go, how fast, or how it is to lean; when it starts and lands; where it is.
//
// What a robot obeys that takes several of these commands: the task, while it is another than Fly; then the attitude
// while it is active; then the position while that is not on hold; else the speed.
#pragma once
#include <array>
#include <cstdint>

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

/// Lean, turn rate and thrust: for controllers that balance the robot themselves. Safe value: not active.
struct QuadrotorAttitude : Command {
  static constexpr std::string_view kName = "quadrotor_attitude";
  static constexpr std::string_view kDoc = "Lean, turn rate and thrust to fly with.";

  bool active = false;     ///< the rest counts
  double roll_rad = 0.0;   ///< about x, right-handed: positive leans to the right
  double pitch_rad = 0.0;  ///< about y, right-handed: positive leans forward
  double yaw_rad_s = 0.0;  ///< counter-clockwise seen from above
  double thrust = 0.0;     ///< along the body's z axis, in parts of the robot's weight: 1 hovers when level

  void set(double roll, double pitch, double turn_rad_s, double thrust_weights) noexcept {
    active = true;
    roll_rad = roll;
    pitch_rad = pitch;
    yaw_rad_s = turn_rad_s;
    thrust = thrust_weights;
  }
  void release() noexcept { *this = {}; }
  void describe(FieldList& f) const {
    f.add("active", active, unit::none, Frame::None, Fusion::Real, "the rest counts");
    f.add("roll", roll_rad, unit::rad, Frame::Body, Fusion::Real, "lean about x, positive to the right");
    f.add("pitch", pitch_rad, unit::rad, Frame::Body, Fusion::Real, "lean about y, positive forward");
    f.add("yaw_rate", yaw_rad_s, unit::rad_s, Frame::World, Fusion::Real, "turn rate, counter-clockwise from above");
    f.add("thrust", thrust, unit::none, Frame::Body, Fusion::Real, "in parts of the robot's weight");
  }
};

/// What a flying robot is to do as a whole. The numbers are part of the port.
enum class FlightOrder : std::uint8_t {
  Fly = 0,      ///< as the other commands say; on the ground or at the ceiling: stay there
  TakeOff = 1,  ///< rise to 1 m, then hover
  Land = 2,     ///< sink to what is beneath, motors off
  Attach = 3,   ///< rise to the ceiling, hold on to it, motors off
  Detach = 4    ///< let go of the ceiling, then hover
};

/// Taking off, landing, holding on to the ceiling. An order that is given again while it is carried out, or has been,
/// changes nothing. Safe value: Fly, which is to hover for a robot in the air.
struct FlightTask : Command {
  static constexpr std::string_view kName = "flight_task";
  static constexpr std::string_view kDoc = "Take off, land, attach to the ceiling, detach.";

  FlightOrder order = FlightOrder::Fly;
  double speed_m_s = 0.0;  ///< of climbing or sinking; 0: the robot's own

  void describe(FieldList& f) const {
    f.add("order", order, unit::none, Frame::None, Fusion::Real, "0 fly, 1 take off, 2 land, 3 attach, 4 detach");
    f.add("speed", speed_m_s, unit::m_s, Frame::None, Fusion::Real, "of climbing or sinking; 0: the robot's own");
  }
};

/// What a flying robot does. The numbers are part of the port.
enum class FlightPhase : std::uint8_t {
  Off = 0,  ///< without power
  Landed = 1,
  TakingOff = 2,
  Hovering = 3,
  Flying = 4,  ///< to a place, at a velocity or with an attitude
  Landing = 5,
  Attaching = 6,
  Attached = 7,
  Detaching = 8,
  Stopped = 9  ///< motors cut in an emergency
};

/// Why a flying robot does not do as told. The numbers are part of the port.
enum class FlightFailsafe : std::uint8_t {
  None = 0,
  CommandTimeout = 1,
  LinkLost = 2,
  LowBattery = 3,
  NoPosition = 4,
  Geofence = 5,
  Hardware = 6
};

/// What the robot does at the moment, and how fast it moves.
struct FlightState : Reading {
  static constexpr std::string_view kName = "flight_state";
  static constexpr std::string_view kDoc = "Phase of the flight, fail-safe, velocity.";

  FlightPhase phase = FlightPhase::Off;
  FlightFailsafe failsafe = FlightFailsafe::None;
  std::array<double, 3> velocity{};  ///< in W, m/s
  double yaw_rad_s = 0.0;            ///< counter-clockwise seen from above

  void describe(FieldList& f) const {
    f.add("phase", phase, unit::none, Frame::None, Fusion::Real,
          "0 off, 1 landed, 2 taking off, 3 hovering, 4 flying, 5 landing, 6 attaching, 7 attached, 8 detaching, 9 "
          "stopped");
    f.add("failsafe", failsafe, unit::none, Frame::None, Fusion::Real,
          "0 none, 1 command timed out, 2 link lost, 3 low battery, 4 no position, 5 geofence, 6 hardware");
    f.add("velocity", velocity, unit::m_s, Frame::World, Fusion::Real, "velocity of the body");
    f.add("yaw_rate", yaw_rad_s, unit::rad_s, Frame::World, Fusion::Real, "turn rate, counter-clockwise from above");
  }
};

/// Distances straight down and straight up. Negative: no echo.
struct Altimeter : Reading {
  static constexpr std::string_view kName = "altimeter";
  static constexpr std::string_view kDoc = "Distance to what is beneath and to what is above.";

  float ground_m = -1.0F;   ///< from the body's base to what is beneath it
  float ceiling_m = -1.0F;  ///< from the body's top to what is above it

  void describe(FieldList& f) const {
    f.add("ground", ground_m, unit::m, Frame::Body, Fusion::Real, "base to what is beneath; negative: no echo");
    f.add("ceiling", ceiling_m, unit::m, Frame::Body, Fusion::Real, "top to what is above; negative: no echo");
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
