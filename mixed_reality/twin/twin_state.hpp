// What a real robot does to its entity in one tick, besides its readings: plain data that a record holds.
#pragma once
#include <cstdint>

#include "core/space/space.hpp"
#include "hal/device/distance_scanner.hpp"
#include "hal/port.hpp"
#include "hal/time.hpp"

namespace tandem::mixed_reality {

/// Decided in every tick by clocks, links, trackers and the safety table; what comes of it in the space is a function
/// of these values alone.
struct TwinState {
  static constexpr std::string_view kName = "twin";
  static constexpr std::string_view kDoc = "What real robots did to their twins.";

  bool takes_part = true;   ///< false: from this tick on its entity is a simulated robot
  bool held = false;        ///< by the safety table
  std::uint8_t senses = 0;  ///< bits of core::RealSense: which others it measures itself
  double x_m = 0.0, y_m = 0.0, z_m = 0.0, cos_h = 1.0, sin_h = 0.0;  ///< where its entity comes to
  double turret_rad = 0.0, turret_rad_s = 0.0;
  hal::ScannerMode scanner = hal::ScannerMode::Off;
  double scanner_rad = 0.0, scanner_swept_rad = 0.0;
  double pan_rad = 0.0, tilt_rad = 0.0;
  bool laser = false;
  bool has_aperture = false;  ///< the next one counts
  double aperture_rad = 0.0;  ///< of the gripper
  /// The place that its controller is told where no device measures it; Absent: none.
  hal::Validity place_validity = hal::Validity::Absent;
  hal::TimeNs place_taken_ns = 0;
  double place_x_m = 0.0, place_y_m = 0.0, place_z_m = 0.0, place_qw = 1.0, place_qz = 0.0;

  core::Pose pose() const noexcept { return {x_m, y_m, z_m, cos_h, sin_h}; }
  void set_pose(const core::Pose& pose) noexcept {
    x_m = pose.x_m;
    y_m = pose.y_m;
    z_m = pose.z_m;
    cos_h = pose.cos_h;
    sin_h = pose.sin_h;
  }

  void describe(hal::FieldList& f) const;
};

/// Puts turret, gripper, scanner and camera's head where the state says, as far as the entity has them and is led from
/// outside.
void apply_mechanisms(core::Space& space, core::RobotId robot, const TwinState& state) noexcept;

}  // namespace tandem::mixed_reality
