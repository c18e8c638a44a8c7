// Sources: [ARGoS] ARGoS 3, eye-bot plug-in; [ARGoS 2] the control interface of the real robot as published with
// ARGoS 2; chosen: no figure is published, the reason stands beside.
#include "hal/robot/eyebot.hpp"

#include <numbers>

#include "hal/device/body_sensors.hpp"
#include "hal/device/cameras.hpp"
#include "hal/device/distance_scanner.hpp"
#include "hal/device/flight.hpp"
#include "hal/device/leds.hpp"
#include "hal/device/pan_tilt.hpp"
#include "hal/device/range_and_bearing.hpp"
#include "hal/device/ring_sensors.hpp"
#include "hal/robot/ring.hpp"
#include "hal/robot/shell.hpp"

namespace tandem::hal::eyebot {
namespace {

constexpr double kPi = std::numbers::pi;
constexpr double kRadius_m = 0.25;
constexpr double kRingRadius_m = 0.255;
constexpr double kRingHeight_m = 0.1635;  // of proximity and light sensors and the upper LEDs, above the base
constexpr double kLedHeight_m = 0.1535;

RobotKind make() {
  RobotKind kind;
  kind.name = kName;
  kind.summary = "The Swarmanoid project's flying robot.";
  kind.body = {.radius_m = kRadius_m, .height_m = 0.566, .mass_kg = 1.0, .source = "ARGoS 3"};
  kind.locomotion = Quadrotor{
      .max_speed_m_s = 2.0,
      .max_acceleration_m_s2 = 3,
      .max_turn_rad_s = 0.5 * kPi,
      .max_lean_rad = 30.0 * (kPi / 180.0),
      .max_thrust = 2.0,
      .climb_m_s = 0.5,
      .sink_m_s = 0.3,
      .take_off_m = 1.0,
      .inertia_kg_m2 = 0.01,
      .rotor_arm_m = 0.2,
      .rotor_lag_s = 0.03,
      .rotor_torque_m = 0.016,
      .source =
          "inertia: ARGoS 3; chosen: speed (stops within 0.7 m, a quarter of what proximity sees), acceleration "
          "(a lean of 17 degrees), turn (a quarter a second), lean (6 m/s2 to the side), thrust (as common "
          "quadrotors have), climb (hovers in two seconds), sink (touches down without bouncing), rotors (their "
          "middles lie within the body; common small motors lag 20 to 50 ms; common propellers of that size)"};
  kind.add(ProximityPart{.range_m = 3.0,
                         .mounts = ring_of(24, 7.5, kRingRadius_m, kRingHeight_m),
                         .response = {},
                         .source = "ARGoS 3: the first at 7.5 degrees, one every 15 degrees, counter-clockwise"});
  kind.add(LightPart{
      {.mounts = ring_of(24, 7.5, kRingRadius_m, kRingHeight_m), .source = "ARGoS 3: beside the proximity sensors"}});
  kind.add(AccelerometerPart{.source = "chosen: every autopilot has one"});
  kind.add(GyroscopePart{.source = "chosen: every autopilot has one"});
  kind.add(AltimeterPart{.range_m = 6.0, .source = "chosen: what common ultrasound rangers reach"});
  kind.add(BatteryPart{.full_V = 12.6,
                       .empty_V = 9.9,
                       .low_charge = 0.15,
                       .source = "chosen: three lithium-polymer cells; it lands while a minute of flight is left"});
  kind.add(RangeAndBearingPart{.range_m = 3.0, .height_m = kRingHeight_m, .payload = 10, .source = "ARGoS 3"});
  const std::string spreads = "; the spread of both rings is chosen so that between them none are out of sight";
  kind.add(LedsPart{.spread = {-1.0, -0.5, true},
                    .mounts = ring_of(16, 11.25, kRingRadius_m, kLedHeight_m),
                    .source = "ARGoS 3: the first at 11.25 degrees; ARGoS 2: they shine downwards" + spreads});
  kind.add(UpperLedsPart{.spread = {-0.5 * std::numbers::sqrt2, 0.5 * std::numbers::sqrt2, false},
                         .mounts = ring_of(16, 11.25, kRingRadius_m, kRingHeight_m),
                         .source = "ARGoS 3: the first at 11.25 degrees; ARGoS 2: they shine sideways" + spreads});
  kind.add(CameraLedPart{.source = "ARGoS 2"});
  kind.add(ScannerPart{
      .height_m = 0.1,
      .turn_rad_s = 2.0 * kPi,
      .rate_hz = 60.0,
      .heads = {{0.0, 0.12, 3.0}, {0.5 * kPi, 0.12, 3.0}, {kPi, 0.12, 3.0}, {-0.5 * kPi, 0.12, 3.0}},
      .source =
          "ARGoS 2: four heads like the foot-bot's turn beneath the body; ranges are chosen: from beside the body, "
          "which is open beneath, as far as proximity sensors see"});
  kind.add(CameraPart{.usual = {0.0, 0.0, -0.5 * kPi},
                      .front = {kRadius_m, kLedHeight_m, 0.0},
                      .aperture_rad = 30.0 * (kPi / 180.0),
                      .focal_length_m = 0.035,
                      .range_m = 3.5,
                      .width_px = 640,
                      .height_px = 480,
                      .source =
                          "chosen: looks down from the base or ahead from the rim; figures of the foot-bot's, but "
                          "that it sees the ground from as high as range-and-bearing reaches"});
  kind.add(HeadPart{.turn_rad_s = kPi,
                    .max_tilt_rad = 0.5 * kPi,
                    .source = "tilt: ARGoS 3, from straight down to level; turn: chosen, half a turn a second"});
  kind.add(ShellPart{.of = std::string(kName), .source = "drawn from memory; sizes as of body and rotors"});
  return kind;
}

}  // namespace

/// A ring of carbon that carries LEDs and sensors, two rotors above each other at the end of each arm, a core that
/// hangs between them, and the mast that holds on to the ceiling.
LookPart shell() {
  constexpr std::string_view kCarbon = "#2b3036", kBlade = "#a9b3bf";
  constexpr double kArm_m = 0.2, kRotor_m = 0.092;
  LookPart look{.whole = true};
  std::vector<Appearance::Link>& all = look.links;
  all.push_back(round_piece("ring", kCarbon, 0.0, 0.0, kRadius_m, 0.148, 0.169));
  for (const double turned_deg : {0.0, 45.0, 90.0, 135.0}) {
    all.push_back(piece("box", kCarbon, {-kRadius_m + 0.005, -0.005, 0.154}, {kRadius_m - 0.005, 0.005, 0.164}));
    all.back().turned_rad = turned_deg * (kPi / 180.0);
  }
  for (const double x_m : {kArm_m * 0.70710678, -kArm_m * 0.70710678}) {
    for (const double y_m : {kArm_m * 0.70710678, -kArm_m * 0.70710678}) {
      all.push_back(round_piece("cylinder", "#15181c", x_m, y_m, 0.014, 0.1, 0.22));  // motors
      for (const double z_m : {0.105, 0.212})
        all.push_back(round_piece("cylinder", x_m > 0.0 ? "#d9705f" : kBlade, x_m, y_m, kRotor_m, z_m, z_m + 0.004));
    }
  }
  all.push_back(round_piece("cylinder", "#e3e6ea", 0.0, 0.0, 0.055, 0.04, 0.25));
  all.push_back(round_piece("cylinder", "#1f6b45", 0.0, 0.0, 0.07, 0.25, 0.256));
  all.push_back(round_piece("cylinder", "#59616c", 0.0, 0.0, 0.035, 0.256, 0.33));
  all.push_back(round_piece("cylinder", "#7a838e", 0.0, 0.0, 0.009, 0.33, 0.55));
  all.push_back(round_piece("cylinder", kCarbon, 0.0, 0.0, 0.032, 0.55, 0.566));
  all.push_back(piece("box", "#d9705f", {0.045, -0.02, 0.19}, {0.06, 0.02, 0.235}));  // the front
  for (const double x_m : {0.05, -0.05}) {
    for (const double y_m : {0.05, -0.05})
      all.push_back(round_piece("cylinder", kCarbon, x_m, y_m, 0.004, 0.0, 0.1));  // legs
  }
  return look;
}

const RobotKind& kind() {
  static const RobotKind made = make();
  return made;
}

}  // namespace tandem::hal::eyebot
