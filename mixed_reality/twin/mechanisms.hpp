// Says where the mechanisms of a twin are, following those of its robot: turret, gripper, distance scanner, camera's
// head; and what the robot senses by itself.
#pragma once
#include "core/space/space.hpp"
#include "hal/device/cameras.hpp"
#include "hal/device/distance_scanner.hpp"
#include "hal/device/gripper.hpp"
#include "hal/device/pan_tilt.hpp"
#include "hal/device/range_and_bearing.hpp"
#include "hal/device/ring_sensors.hpp"
#include "hal/device/time_of_flight.hpp"
#include "hal/device/turret.hpp"
#include "mixed_reality/fusion/port_fusion.hpp"
#include "mixed_reality/twin/twin_state.hpp"

namespace tandem::mixed_reality {

/// A mechanism stands where the robot's own sensor says; where there is none, where its commands have led it, as fast
/// as its kind allows.
class Mechanisms {
 public:
  /// Asks `real` only for what the robot's controller reads or commands. What it returns and the space must outlive
  /// this.
  Mechanisms(const core::Space& space, core::RobotId robot, const RealReadings& real);

  /// To be called once a tick, after the robot's readings were latched; writes its part of `state`.
  void follow(double tick_s, TwinState& state) noexcept;

 private:
  template <class Port>
  bool takes() const noexcept;
  template <class Sensor>
  const Sensor* if_used(const RealReadings& real, bool used) const;
  void follow_gripper(TwinState& state) noexcept;
  void follow_turret(double tick_s, TwinState& state) noexcept;
  void follow_scanner(double tick_s, TwinState& state) noexcept;
  void follow_head(double tick_s, TwinState& state) noexcept;
  std::uint8_t senses() const noexcept;

  const core::Space& space_;
  core::RobotId robot_;
  const hal::TurretDrive* turret_drive_;  // null, as the rest: its controller took none, or the robot has none
  const hal::GripperDrive* gripper_drive_;
  const hal::ScannerDrive* scanner_drive_;
  const hal::PanTiltDrive* head_drive_;
  const hal::TurretEncoder* turret_;
  const hal::Gripper* gripper_;
  const hal::DistanceScanner* scanner_;
  const hal::PanTiltEncoder* head_;
  const hal::Proximity* proximity_;
  const hal::TimeOfFlight* time_of_flight_;
  const hal::RangeAndBearing* messages_;
  const hal::OmnidirectionalCamera* omni_camera_;
  const hal::PerspectiveCamera* lens_camera_;
  double turret_rad_ = 0.0, scanner_rad_ = 0.0, pan_rad_ = 0.0, tilt_rad_ = 0.0;
};

}  // namespace tandem::mixed_reality
