#include "mixed_reality/twin/twin_state.hpp"

#include "core/space/mechanisms.hpp"
#include "hal/unit.hpp"

namespace tandem::mixed_reality {

void TwinState::describe(hal::FieldList& f) const {
  f.add("takes_part", takes_part, hal::unit::none, "0: from this tick on it is a simulated robot");
  f.add("held", held, hal::unit::none, "by the safety table");
  f.add("senses", senses, hal::unit::none, "bits of what it senses of other real robots itself");
  f.add("x", x_m, hal::unit::m, "in W, where its twin came to");
  f.add("y", y_m, hal::unit::m, "in W");
  f.add("z", z_m, hal::unit::m, "of the base");
  f.add("cos", cos_h, hal::unit::none, "of the heading");
  f.add("sin", sin_h, hal::unit::none, "of the heading");
  f.add("turret", turret_rad, hal::unit::rad, "on the body");
  f.add("turret_speed", turret_rad_s, hal::unit::rad_s, "");
  f.add("scanner_mode", scanner, hal::unit::none, "as ScannerDrive::mode");
  f.add("scanner", scanner_rad, hal::unit::rad, "of the first sensor");
  f.add("scanner_swept", scanner_swept_rad, hal::unit::rad, "in the tick");
  f.add("pan", pan_rad, hal::unit::rad, "of the camera's head");
  f.add("tilt", tilt_rad, hal::unit::rad, "0 straight down");
  f.add("laser", laser, hal::unit::none, "lit");
  f.add("has_aperture", has_aperture, hal::unit::none, "the next one counts");
  f.add("aperture", aperture_rad, hal::unit::rad, "of the claws");
  f.add("place_validity", place_validity, hal::unit::none, "of the place that its controller is told; 0: none is");
  f.add("place_taken_ns", place_taken_ns, hal::unit::none, "when it was there");
  f.add("place_x", place_x_m, hal::unit::m, "in W");
  f.add("place_y", place_y_m, hal::unit::m, "in W");
  f.add("place_z", place_z_m, hal::unit::m, "in W");
  f.add("place_qw", place_qw, hal::unit::none, "of the attitude");
  f.add("place_qz", place_qz, hal::unit::none, "of the attitude");
}

void apply_mechanisms(core::Space& space, core::RobotId robot, const TwinState& s) noexcept {
  if (!space.external(robot)) return;
  if (auto* const turret = space.state<core::TurretState>(robot); turret != nullptr)
    *turret = {hal::TurretMode::Off, 0.0, s.turret_rad, s.turret_rad_s};
  if (auto* const scanner = space.state<core::ScannerState>(robot); scanner != nullptr)
    *scanner = {s.scanner, s.scanner_rad, s.scanner_swept_rad};
  if (auto* const head = space.state<core::HeadState>(robot); head != nullptr) *head = {s.pan_rad, s.tilt_rad, s.laser};
  if (auto* const grip = space.state<core::GripState>(robot); grip != nullptr && s.has_aperture)
    grip->aperture_rad = s.aperture_rad;
}

}  // namespace tandem::mixed_reality
