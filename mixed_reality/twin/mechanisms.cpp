#include "mixed_reality/twin/mechanisms.hpp"

#include <algorithm>
#include <cmath>

#include "core/space/mechanisms.hpp"
#include "hal/angle.hpp"

namespace tandem::mixed_reality {
namespace {

/// The fastest turn of a part; 0: robots of the kind have none.
template <class Part>
double turn_rad_s(const hal::RobotKind& kind) noexcept {
  const Part* const part = kind.part<Part>();
  return part != nullptr ? part->turn_rad_s : 0.0;
}

/// Whether the device is there and has ever measured.
bool there(const hal::Reading* reading) noexcept {
  return reading != nullptr && reading->validity != hal::Validity::Absent;
}

/// One tick of the way to `target_rad` by the shorter way round.
double step_to(double target_rad, double from_rad, double most_rad) noexcept {
  return std::clamp(hal::wrapped(target_rad - from_rad), -most_rad, most_rad);
}

}  // namespace

template <class Port>
bool Mechanisms::takes() const noexcept {
  return space_.port<Port>(robot_) != nullptr;
}

template <class Sensor>
const Sensor* Mechanisms::if_used(const RealReadings& real, bool used) const {
  return used ? static_cast<const Sensor*>(real(hal::port_type<Sensor>())) : nullptr;
}

Mechanisms::Mechanisms(const core::Space& space, core::RobotId robot, const RealReadings& real)
    : space_(space),
      robot_(robot),
      turret_drive_(space.port<hal::TurretDrive>(robot)),
      gripper_drive_(space.port<hal::GripperDrive>(robot)),
      scanner_drive_(space.port<hal::ScannerDrive>(robot)),
      head_drive_(space.port<hal::PanTiltDrive>(robot)) {
  turret_ = if_used<hal::TurretEncoder>(real, turret_drive_ != nullptr || takes<hal::TurretEncoder>());
  gripper_ = if_used<hal::Gripper>(real, gripper_drive_ != nullptr || takes<hal::Gripper>());
  scanner_ = if_used<hal::DistanceScanner>(real, takes<hal::DistanceScanner>());
  head_ = if_used<hal::PanTiltEncoder>(real, head_drive_ != nullptr || takes<hal::PanTiltEncoder>());
  time_of_flight_ = if_used<hal::TimeOfFlight>(real, takes<hal::TimeOfFlight>());
  proximity_ = if_used<hal::Proximity>(real, takes<hal::Proximity>());
  messages_ = if_used<hal::RangeAndBearing>(real, takes<hal::RangeAndBearing>() || takes<hal::RangeAndBearingSend>());
  omni_camera_ = if_used<hal::OmnidirectionalCamera>(real, takes<hal::OmnidirectionalCamera>());
  lens_camera_ = if_used<hal::PerspectiveCamera>(real, takes<hal::PerspectiveCamera>());
}

void Mechanisms::follow(double tick_s, TwinState& state) noexcept {
  state.senses = senses();
  follow_turret(tick_s, state);
  follow_scanner(tick_s, state);
  follow_head(tick_s, state);
  follow_gripper(state);
}

std::uint8_t Mechanisms::senses() const noexcept {
  using core::RealSense;
  unsigned senses = 0;
  const auto add = [&senses](const hal::Reading* reading, RealSense sense) {
    if (there(reading)) senses |= core::bit(sense);
  };
  add(proximity_, RealSense::Proximity);
  add(scanner_, RealSense::Scanner);
  add(time_of_flight_, RealSense::TimeOfFlight);
  add(messages_, RealSense::Messages);
  add(omni_camera_, RealSense::OmniCamera);
  add(lens_camera_, RealSense::LensCamera);
  return static_cast<std::uint8_t>(senses);
}

void Mechanisms::follow_gripper(TwinState& state) noexcept {
  state.has_aperture = there(gripper_) || gripper_drive_ != nullptr;
  if (there(gripper_))
    state.aperture_rad = static_cast<double>(gripper_->aperture_rad);
  else if (gripper_drive_ != nullptr)
    state.aperture_rad = gripper_drive_->aperture_rad;
}

void Mechanisms::follow_turret(double tick_s, TwinState& state) noexcept {
  double step_rad = 0.0;
  if (there(turret_)) {
    step_rad = hal::wrapped(turret_->angle_rad - turret_rad_);
  } else if (turret_drive_ != nullptr && turret_drive_->mode == hal::TurretMode::Speed) {
    step_rad = turret_drive_->speed_rad_s * tick_s;
  } else if (turret_drive_ != nullptr && turret_drive_->mode == hal::TurretMode::Position) {
    step_rad =
        step_to(turret_drive_->angle_rad, turret_rad_, turn_rad_s<hal::TurretPart>(space_.kind(robot_)) * tick_s);
  }
  turret_rad_ = hal::wrapped(turret_rad_ + step_rad);
  state.turret_rad = turret_rad_;
  state.turret_rad_s = there(turret_) ? static_cast<double>(turret_->speed_rad_s)
                       : tick_s > 0.0 ? step_rad / tick_s
                                      : 0.0;
}

/// The virtual heads measure where the real ones do: they sweep what was commanded, and end where the robot says. One
/// that measures without having been told to stands still.
void Mechanisms::follow_scanner(double tick_s, TwinState& state) noexcept {
  hal::ScannerMode mode = scanner_drive_ == nullptr ? hal::ScannerMode::Off : scanner_drive_->mode;
  double swept_rad = 0.0;
  if (mode == hal::ScannerMode::Speed) swept_rad = scanner_drive_->speed_rad_s * tick_s;
  if (there(scanner_)) {
    if (scanner_->count == 0) mode = hal::ScannerMode::Off;
    if (scanner_->count > 0 && mode == hal::ScannerMode::Off) mode = hal::ScannerMode::Position;
    scanner_rad_ = static_cast<double>(scanner_->turn_rad);
  } else {
    if (mode == hal::ScannerMode::Position) {
      swept_rad =
          step_to(scanner_drive_->angle_rad, scanner_rad_, turn_rad_s<hal::ScannerPart>(space_.kind(robot_)) * tick_s);
    }
    scanner_rad_ = hal::wrapped(scanner_rad_ + swept_rad);
  }
  state.scanner = mode;
  state.scanner_rad = hal::wrapped(scanner_rad_);
  state.scanner_swept_rad = swept_rad;
}

void Mechanisms::follow_head(double tick_s, TwinState& state) noexcept {
  if (there(head_)) {
    pan_rad_ = head_->pan_rad;
    tilt_rad_ = head_->tilt_rad;
  } else if (head_drive_ != nullptr) {
    const double most_rad = turn_rad_s<hal::HeadPart>(space_.kind(robot_)) * tick_s;
    pan_rad_ = hal::wrapped(pan_rad_ + step_to(head_drive_->pan_rad, pan_rad_, most_rad));
    tilt_rad_ += std::clamp(head_drive_->tilt_rad - tilt_rad_, -most_rad, most_rad);
  }
  state.pan_rad = hal::wrapped(pan_rad_);
  state.tilt_rad = tilt_rad_;
  state.laser = head_drive_ != nullptr && head_drive_->laser;
}

}  // namespace tandem::mixed_reality
