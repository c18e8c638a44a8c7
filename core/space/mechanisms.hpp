// Moving parts of robots, what they hold, and the state of flight. Angles are relative to the body, counter-clockwise
// from forward.
#pragma once
#include <array>
#include <cstdint>

#include "core/scenario/engine_traits.hpp"
#include "hal/device/distance_scanner.hpp"
#include "hal/device/flight.hpp"
#include "hal/device/turret.hpp"
#include "hal/port.hpp"

namespace tandem::core {

/// A turret: its command, and its place.
struct TurretState {
  static constexpr std::string_view kName = "turret";
  static constexpr std::string_view kDoc = "What turrets were told, and where they are.";
  hal::TurretMode mode = hal::TurretMode::Off;
  double target = 0.0;  ///< Speed: rad/s; Position: rad
  double angle_rad = 0.0;
  double speed_rad_s = 0.0;  ///< over the last tick

  void describe(hal::FieldList& f) const {
    f.add("mode", mode, hal::unit::none, "as TurretDrive::mode");
    f.add("target", target, hal::unit::none, "of the speed in rad/s or the angle in rad");
    f.add("angle", angle_rad, hal::unit::rad, "of the turret on the body");
    f.add("speed", speed_rad_s, hal::unit::rad_s, "over the last tick");
  }
};

/// Joints that an engine must have for grippers: loads are firm, or turn with the turret.
inline constexpr JointKinds kJointsOfGrips = bit(JointKind::Fixed) | bit(JointKind::Turning);

/// A gripper. What it holds is joined to the turret that it sits on.
struct GripState {
  static constexpr std::uint32_t kNothing = 0xFFFF'FFFFU;
  static constexpr std::string_view kName = "gripper";
  static constexpr std::string_view kDoc = "What grippers hold.";

  double aperture_rad = 0.0;
  bool wants = false;              ///< the claws are open: they hold what is there
  bool slips = false;              ///< … but fail to in this tick
  std::uint32_t joint = kNothing;  ///< index into SpaceStores::joints
  std::uint32_t generation = 0;    ///< of that joint
  double turn_rad = 0.0;           ///< the turret's angle less the heading of what is held, relative to the robot's
  std::uint32_t grips = 0;         ///< times that something was gripped

  bool holding() const noexcept { return joint != kNothing; }

  void describe(hal::FieldList& f) const {
    f.add("aperture", aperture_rad, hal::unit::rad, "of the claws");
    f.add("wants", wants, hal::unit::none, "the claws hold what is there");
    f.add("slips", slips, hal::unit::none, "the claws fail to hold in this tick");
    f.add("joint", joint, hal::unit::none, "number of the joint to what is held");
    f.add("turn", turn_rad, hal::unit::rad, "of the turret less the heading of what is held");
    f.add("grips", grips, hal::unit::none, "times that something was gripped");
  }
};

/// A distance scanner.
struct ScannerState {
  static constexpr std::string_view kName = "distance_scanner";
  static constexpr std::string_view kDoc = "How scanners turn.";
  hal::ScannerMode mode = hal::ScannerMode::Off;
  double angle_rad = 0.0;
  double swept_rad = 0.0;  ///< in the last tick

  void describe(hal::FieldList& f) const {
    f.add("mode", mode, hal::unit::none, "as ScannerDrive::mode");
    f.add("angle", angle_rad, hal::unit::rad, "of the first sensor");
    f.add("swept", swept_rad, hal::unit::rad, "in the last tick");
  }
};

/// The head of a camera.
struct HeadState {
  static constexpr std::string_view kName = "camera_head";
  static constexpr std::string_view kDoc = "Where cameras look.";
  double pan_rad = 0.0;
  double tilt_rad = 0.0;  ///< 0 straight down, pi/2 level
  bool laser = false;

  void describe(hal::FieldList& f) const {
    f.add("pan", pan_rad, hal::unit::rad, "about the vertical");
    f.add("tilt", tilt_rad, hal::unit::rad, "0 straight down");
    f.add("laser", laser, hal::unit::none, "lit");
  }
};

/// Commands of a controller to its flying robot in this tick, through all the devices that it took.
struct FlightSetpoint {
  static constexpr std::string_view kName = "flight_setpoint";
  static constexpr std::string_view kDoc = "What controllers ask of flying robots, through all their devices.";
  bool to_place = false;  ///< the next two count
  std::array<double, 3> target_m{};
  double heading_rad = 0.0;
  std::array<double, 3> velocity_m_s{};
  double turn_rad_s = 0.0;
  hal::QuadrotorAttitude attitude;
  hal::FlightTask task;

  void describe(hal::FieldList& f) const {
    f.add("to_place", to_place, hal::unit::none, "target and heading count");
    f.add("target", target_m, hal::unit::m, "in W");
    f.add("heading", heading_rad, hal::unit::rad, "in W");
    f.add("velocity", velocity_m_s, hal::unit::m_s, "in W");
    f.add("turn", turn_rad_s, hal::unit::rad_s, "about the vertical");
    f.add("by_attitude", attitude.active, hal::unit::none, "the next four count");
    f.add("roll", attitude.roll_rad, hal::unit::rad, "as QuadrotorAttitude");
    f.add("pitch", attitude.pitch_rad, hal::unit::rad, "as QuadrotorAttitude");
    f.add("yaw_rate", attitude.yaw_rad_s, hal::unit::rad_s, "as QuadrotorAttitude");
    f.add("thrust", attitude.thrust, hal::unit::none, "in parts of the weight");
    f.add("order", task.order, hal::unit::none, "as FlightTask");
    f.add("task_speed", task.speed_m_s, hal::unit::m_s, "as FlightTask");
  }
};

/// Progress of a flying robot's task.
struct PilotState {
  static constexpr std::string_view kName = "pilot";
  static constexpr std::string_view kDoc = "How far flying robots are with their tasks.";
  hal::FlightPhase phase = hal::FlightPhase::Landed;
  hal::FlightOrder order = hal::FlightOrder::Fly;  ///< the last one
  bool started = false;                            ///< it was looked where the robot stands
  std::uint32_t stuck_ticks = 0;                   ///< in which it did not sink though it was to
  std::array<double, 3> place_m{};                 ///< where it hovers, or rises to
  double heading_rad = 0.0;                        ///< with which it hovers

  void describe(hal::FieldList& f) const {
    f.add("phase", phase, hal::unit::none, "as FlightPhase");
    f.add("order", order, hal::unit::none, "the last one");
    f.add("started", started, hal::unit::none, "it was looked where the robot stands");
    f.add("stuck_ticks", stuck_ticks, hal::unit::none, "in which it did not sink though it was to");
    f.add("place", place_m, hal::unit::m, "where it hovers, or rises to, in W");
    f.add("heading", heading_rad, hal::unit::rad, "with which it hovers, in W");
  }
};

/// The rotors of a flying robot, where its engine simulates them.
struct RotorState {
  static constexpr std::string_view kName = "rotors";
  static constexpr std::string_view kDoc = "Thrust of rotors that are simulated.";
  bool spun = false;  ///< they were simulated before: until then thrust is what holds the robot up
  std::array<double, 4> thrust_N{};

  void describe(hal::FieldList& f) const {
    f.add("spun", spun, hal::unit::none, "they were simulated before");
    f.add("thrust", thrust_N, hal::unit::none, "in N");
  }
};

/// A battery's charge, in the units of its configuration.
struct ChargeState {
  static constexpr std::string_view kName = "battery";
  static constexpr std::string_view kDoc = "Charge of batteries.";

  double charge = 0.0;

  void describe(hal::FieldList& f) const { f.add("charge", charge, hal::unit::none, "as the configuration counts it"); }
};

/// Rolled distance that encoders cannot see.
struct HiddenRoll {
  static constexpr std::string_view kName = "hidden_roll";
  static constexpr std::string_view kDoc = "What wheels rolled beyond what their encoders can see.";
  double left_m = 0.0, right_m = 0.0;  ///< since the start
  double left_m_s = 0.0, right_m_s = 0.0;

  void describe(hal::FieldList& f) const {
    f.add("left", left_m, hal::unit::m, "since the start");
    f.add("right", right_m, hal::unit::m, "since the start");
    f.add("left_speed", left_m_s, hal::unit::m_s, "");
    f.add("right_speed", right_m_s, hal::unit::m_s, "");
  }
};

}  // namespace tandem::core
