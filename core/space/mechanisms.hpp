// What turns on robots, what they hold, and how their flight goes. Angles are relative to the body, counter-clockwise
// from forward.
#pragma once
#include <array>
#include <cmath>
#include <cstdint>
#include <numbers>

#include "hal/device/distance_scanner.hpp"
#include "hal/device/flight.hpp"
#include "hal/device/turret.hpp"

namespace tandem::core {

/// A turret: what it was told, and where it is.
struct TurretState {
  hal::TurretMode mode = hal::TurretMode::Off;
  double target = 0.0;  ///< Speed: rad/s; Position: rad
  double angle_rad = 0.0;
  double speed_rad_s = 0.0;  ///< over the last tick
};

/// A gripper. What it holds is joined to the turret that it sits on.
struct GripState {
  static constexpr std::uint32_t kNothing = 0xFFFF'FFFFU;

  double aperture_rad = 0.0;
  bool wants = false;              ///< the claws are open: they hold what is there
  bool slips = false;              ///< … but fail to in this tick
  std::uint32_t joint = kNothing;  ///< index into SpaceStores::joints
  std::uint32_t generation = 0;    ///< of that joint
  double turn_rad = 0.0;           ///< the turret's angle less the heading of what is held, relative to the robot's
  std::uint32_t grips = 0;         ///< times that something was gripped

  bool holding() const noexcept { return joint != kNothing; }
};

/// A distance scanner.
struct ScannerState {
  hal::ScannerMode mode = hal::ScannerMode::Off;
  double angle_rad = 0.0;
  double swept_rad = 0.0;  ///< in the last tick
};

/// The head of a camera.
struct HeadState {
  double pan_rad = 0.0;
  double tilt_rad = 0.0;  ///< 0 straight down, pi/2 level
  bool laser = false;
};

/// What a controller asks of its flying robot in this tick, through all the devices that it took.
struct FlightWish {
  bool to_place = false;  ///< the next two count
  std::array<double, 3> target_m{};
  double heading_rad = 0.0;
  std::array<double, 3> velocity_m_s{};
  double turn_rad_s = 0.0;
  hal::QuadrotorAttitude attitude;
  hal::FlightTask task;
};

/// How far a flying robot is with its task.
struct PilotState {
  hal::FlightPhase phase = hal::FlightPhase::Landed;
  hal::FlightOrder order = hal::FlightOrder::Fly;  ///< the last one
  bool started = false;                            ///< it was looked where the robot stands
  std::uint32_t stuck_ticks = 0;                   ///< in which it did not sink though it was to
  std::array<double, 3> place_m{};                 ///< where it hovers, or rises to
  double heading_rad = 0.0;                        ///< with which it hovers
};

/// The rotors of a flying robot, where its engine simulates them.
struct RotorState {
  bool spun = false;  ///< they were simulated before: until then thrust is what holds the robot up
  std::array<double, 4> thrust_N{};
};

/// What the wheels rolled beyond what their encoders can see.
struct HiddenRoll {
  double left_m = 0.0, right_m = 0.0;  ///< since the start
  double left_m_s = 0.0, right_m_s = 0.0;
};

/// The same direction, in (-pi, pi].
inline double wrapped(double angle_rad) noexcept {
  const double turned = std::remainder(angle_rad, 2.0 * std::numbers::pi);
  return turned <= -std::numbers::pi ? std::numbers::pi : turned;
}

}  // namespace tandem::core
