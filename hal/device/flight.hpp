// Flight of a quadrotor: where it is to go, how fast, or how it is to lean; when it starts and lands; where it is.
//
// What a robot obeys that takes several of these commands: the task, while it is another than Fly; then the attitude
// while it is active; then the position while that is not on hold; else the speed.
#pragma once
#include <algorithm>
#include <array>
#include <cmath>
#include <cstdint>
#include <limits>
#include <string>

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

  using LimitedBy = Quadrotor;
  /// A target that is not finite becomes the safe command, which is to hover; also one that is on hold.
  Limited limit(const Quadrotor&) noexcept {
    bool finite = std::isfinite(yaw_rad);
    for (const double c : target) finite = finite && std::isfinite(c);
    if (finite) return kPassed;
    *this = {};
    return kNotFinite;
  }
  /// A flying robot goes to a target about so fast that it would be there after this time (the eye-bot's controller of
  /// position closes 0.8 to 1.2 of the distance a second).
  static constexpr double kStep_s = 1.0;
  /// A target that is farther away than the robot may come within `kStep_s` is drawn near along the line to it.
  void slow_down(double most_m_s, const Pose* at) noexcept {
    if (hold || at == nullptr) return;
    const std::array<double, 3> p_WB = {at->x_m, at->y_m, at->z_m};
    double way2 = 0.0;
    for (std::size_t i = 0; i < 3; ++i) way2 += (target[i] - p_WB[i]) * (target[i] - p_WB[i]);
    const double most_m = most_m_s * kStep_s;
    if (!(way2 > most_m * most_m)) return;
    const double part = most_m / std::sqrt(way2);
    for (std::size_t i = 0; i < 3; ++i) target[i] = p_WB[i] + part * (target[i] - p_WB[i]);
  }
  /// A target outside becomes the nearest inside. On hold above the ceiling it becomes the place beneath.
  bool keep_inside(const Fence& fence, const Pose& at, double) noexcept {
    if (hold) {
      if (at.z_m <= fence.max_z_m) return false;
      const Pose inside = fence.clamped(at);
      set(inside.x_m, inside.y_m, inside.z_m, at.heading_rad());
      return true;
    }
    const std::array<double, 3> wanted = target;
    target[0] = std::clamp(wanted[0], fence.min_x_m, fence.max_x_m);
    target[1] = std::clamp(wanted[1], fence.min_y_m, fence.max_y_m);
    target[2] = std::min(wanted[2], fence.max_z_m);
    return target != wanted;
  }
  /// Where it goes to is left to its controller: the way there may lead out.
  bool keep_out(const Pose&, double, double) noexcept { return false; }
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

  /// Velocities beyond the limit are shortened along their direction, turn rates clamped; a command that is not finite
  /// becomes the safe one, which is to hover.
  Limited limit_to(double most_m_s, double most_rad_s) noexcept {
    auto& v = velocity;
    // Not by hypot: GCC 12's form of three arguments overlooks what is no number.
    const double speed = std::sqrt(v[0] * v[0] + v[1] * v[1] + v[2] * v[2]);
    const double turn = std::fabs(yaw_rad_s);
    if (speed <= most_m_s && turn <= most_rad_s) return kPassed;  // false when any is NaN
    if (!std::isfinite(v[0]) || !std::isfinite(v[1]) || !std::isfinite(v[2]) || !std::isfinite(turn)) {
      *this = {};
      return kNotFinite;
    }
    const double largest = std::max({std::fabs(v[0]), std::fabs(v[1]), std::fabs(v[2])});
    if (!(speed <= most_m_s)) {
      // In two steps: the length of what is finite need not be.
      for (double& c : v) c /= largest;
      const double scale = most_m_s / std::sqrt(v[0] * v[0] + v[1] * v[1] + v[2] * v[2]);
      for (double& c : v) c *= scale;
    }
    yaw_rad_s = std::clamp(yaw_rad_s, -most_rad_s, most_rad_s);
    return {LimitResult::Clamped, largest, most_m_s};
  }
  using LimitedBy = Quadrotor;
  Limited limit(const Quadrotor& flight) noexcept { return limit_to(flight.max_speed_m_s, flight.max_turn_rad_s); }
  void slow_down(double most_m_s, const Pose*) noexcept { limit_to(most_m_s, std::numeric_limits<double>::max()); }
  /// How fast a robot above the ceiling sinks.
  static constexpr double kSinkIntoFence_m_s = 0.2;
  /// The robot loses the part of its velocity that leads out, and sinks while it is above the ceiling, whatever was
  /// wanted.
  bool keep_inside(const Fence& fence, const Pose& at, double look_ahead_s) noexcept {
    auto& v = velocity;
    const bool x = Fence::leads_out(at.x_m, v[0] * look_ahead_s, fence.min_x_m, fence.max_x_m);
    const bool y = Fence::leads_out(at.y_m, v[1] * look_ahead_s, fence.min_y_m, fence.max_y_m);
    if (x) v[0] = 0.0;
    if (y) v[1] = 0.0;
    bool z = false;
    if (at.z_m > fence.max_z_m) {
      z = v[2] > -kSinkIntoFence_m_s;
      if (z) v[2] = -kSinkIntoFence_m_s;
    } else if (at.z_m + v[2] * look_ahead_s > fence.max_z_m) {
      z = true;
      v[2] = 0.0;
    }
    return x || y || z;
  }
  bool keep_out(const Pose&, double out_x, double out_y) noexcept {
    const double out_m_s = velocity[0] * out_x + velocity[1] * out_y;
    if (out_m_s >= 0.0) return false;
    velocity[0] -= out_m_s * out_x;
    velocity[1] -= out_m_s * out_y;
    return true;
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

  /// Leans, turn rates and thrusts are clamped; a command that is not finite becomes the safe one.
  Limited limit_to(double most_lean_rad, double most_turn_rad_s, double most_thrust) noexcept {
    if (!std::isfinite(roll_rad) || !std::isfinite(pitch_rad) || !std::isfinite(yaw_rad_s) || !std::isfinite(thrust)) {
      *this = {};
      return kNotFinite;
    }
    const QuadrotorAttitude before = *this;
    roll_rad = std::clamp(roll_rad, -most_lean_rad, most_lean_rad);
    pitch_rad = std::clamp(pitch_rad, -most_lean_rad, most_lean_rad);
    yaw_rad_s = std::clamp(yaw_rad_s, -most_turn_rad_s, most_turn_rad_s);
    thrust = std::clamp(thrust, 0.0, most_thrust);
    const bool same = roll_rad == before.roll_rad && pitch_rad == before.pitch_rad && yaw_rad_s == before.yaw_rad_s &&
                      thrust == before.thrust;
    return same ? kPassed : kClamped;
  }
  using LimitedBy = Quadrotor;
  Limited limit(const Quadrotor& flight) noexcept {
    return limit_to(flight.max_lean_rad, flight.max_turn_rad_s, flight.max_thrust);
  }
  void describe(FieldList& f) const {
    f.add("active", active, unit::none, Frame::None, Fusion::Real, "the rest counts");
    f.add("roll", roll_rad, unit::rad, Frame::Body, Fusion::Real, "lean about x, positive to the right");
    f.add("pitch", pitch_rad, unit::rad, Frame::Body, Fusion::Real, "lean about y, positive forward");
    f.add("yaw_rate", yaw_rad_s, unit::rad_s, Frame::World, Fusion::Real, "turn rate, counter-clockwise from above");
    f.add("thrust", thrust, unit::none, Frame::Body, Fusion::Real, "in parts of the robot's weight");
  }
};

/// Task of a flying robot. The numbers are part of the port.
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

  using LimitedBy = Quadrotor;
  /// Speeds are clamped; an order with a speed that is not finite, or that is none, becomes the safe one.
  Limited limit(const Quadrotor& flight) noexcept {
    if (!std::isfinite(speed_m_s) || order > FlightOrder::Detach) {
      *this = {};
      return kNotFinite;
    }
    if (speed_m_s >= 0.0 && speed_m_s <= flight.max_speed_m_s) return kPassed;
    speed_m_s = std::clamp(speed_m_s, 0.0, flight.max_speed_m_s);
    return kClamped;
  }
  void describe(FieldList& f) const {
    f.add("order", order, unit::none, Frame::None, Fusion::Real, "0 fly, 1 take off, 2 land, 3 attach, 4 detach");
    f.add("speed", speed_m_s, unit::m_s, Frame::None, Fusion::Real, "of climbing or sinking; 0: the robot's own");
  }
};

/// Mode of a flying robot. The numbers are part of the port.
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

/// Why a flying robot does not obey. The numbers are part of the port.
enum class FlightFailsafe : std::uint8_t {
  None = 0,
  CommandTimeout = 1,
  LinkLost = 2,
  LowBattery = 3,
  NoPosition = 4,
  Geofence = 5,
  Hardware = 6
};

/// Mode and velocity of a flying robot.
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

/// The altimeter.
struct AltimeterPart {
  static constexpr std::string_view kName = "altimeter";
  static constexpr std::string_view kDoc = "Range sensors that look straight down and straight up.";
  double range_m = 0.0;  ///< farthest echo
  std::string source = {};

  void describe(ParamVisitor& v) {
    v.number("range", range_m, unit::m, {1e-9, 1e4}, "Farthest echo.");
    v.text("source", source, "Where these figures come from.");
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

/// Pose of the robot from a positioning system.
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
