// Sources: [ARGoS] ARGoS 3, foot-bot plug-in; the real robot: its control interface as published with ARGoS 2;
// [marXbot] Bonani et al. 2010; chosen: no figure is published, the reason stands beside.
#include "hal/robot/footbot.hpp"

#include <numbers>
#include <utility>

#include "hal/device/body_sensors.hpp"
#include "hal/device/brakes.hpp"
#include "hal/device/cameras.hpp"
#include "hal/device/distance_scanner.hpp"
#include "hal/device/gripper.hpp"
#include "hal/device/leds.hpp"
#include "hal/device/range_and_bearing.hpp"
#include "hal/device/ring_sensors.hpp"
#include "hal/device/turret.hpp"
#include "hal/robot/ring.hpp"
#include "hal/robot/shell.hpp"

namespace tandem::hal::footbot {
namespace {

constexpr double kPi = std::numbers::pi;
constexpr double kRadius_m = 0.085036758;
constexpr double kWheelBase_m = 0.14;
constexpr double kForce_N = 1.5;
constexpr double kSensorHeight_m = 0.06;  // of proximity and light sensors
constexpr double kBeaconHeight_m = 0.174249733;
constexpr double kCameraHeight_m = 0.2887;  // of both

/// A ring of 12, 5 mm outside the body, and the beacon on the axis.
std::vector<Mount> ring_and_beacon() {
  std::vector<Mount> all = ring_of(12, 15.0, kRadius_m + 0.005, 0.085);
  all.push_back({0.0, 0.0, 0.0, kBeaconHeight_m});
  return all;
}

RobotKind make() {
  RobotKind kind;
  kind.name = kName;
  kind.summary = "The Swarmanoid project's robot on two treels, with turret and gripper.";
  kind.body = {.radius_m = kRadius_m, .height_m = 0.146899733, .mass_kg = 1.6, .source = "ARGoS 3"};
  kind.locomotion = DifferentialDrive{
      .wheel_radius_m = 0.029112741,
      .wheel_base_m = kWheelBase_m,
      .max_speed_m_s = 0.3,
      .force_N = kForce_N,
      .torque_Nm = kForce_N * kWheelBase_m / 2,
      .source =
          "wheels: ARGoS 3 (the real robot measures its own wheel base at the start); speed: the real robot's "
          "interface; force: what ARGoS 3's engines let both treels push with"};
  kind.add(ProximityPart{.range_m = 0.1,
                         .mounts = ring_of(24, 7.5, kRadius_m, kSensorHeight_m),
                         .response = {},
                         .source = "ARGoS 3: the first at 7.5 degrees, one every 15 degrees, counter-clockwise"});
  kind.add(LightPart{
      {.mounts = ring_of(24, 7.5, kRadius_m, kSensorHeight_m), .source = "ARGoS 3: the same devices as proximity"}});
  kind.add(BaseGroundPart{
      {.mounts = {Mount{0, 0.08, 0, 0}, Mount{0, 0.042, 0.065, 0}, Mount{0, 0, 0.08, 0}, Mount{0, -0.042, 0.065, 0},
                  Mount{0, -0.08, 0, 0}, Mount{0, -0.042, -0.065, 0}, Mount{0, 0, -0.08, 0},
                  Mount{0, 0.042, -0.065, 0}},
       .source = "the real robot's interface: eight around the base, the first ahead, counter-clockwise"}});
  kind.add(MotorGroundPart{{.mounts = {Mount{0, 0.063, 0.0116, 0}, Mount{0, -0.063, 0.0116, 0},
                                       Mount{0, -0.063, -0.0116, 0}, Mount{0, 0.063, -0.0116, 0}},
                            .source = "the real robot's interface: four between the tracks, the first front left, "
                                      "counter-clockwise"}});
  kind.add(AccelerometerPart{.source = "the real robot's interface"});
  kind.add(GyroscopePart{.source = "the real robot's interface"});
  kind.add(BrakesPart{.deceleration_m_s2 = 3.0,
                      .source = "chosen: the treels stop from full speed within 0.1 s, about 2 cm"});
  kind.add(BatteryPart{.full_V = 4.2,
                       .empty_V = 3.4,
                       .low_charge = 0.0,
                       .low_V = 3.4,
                       .source = "marXbot: one lithium-polymer cell of 10 Ah; empty as the e-puck's cell"});
  kind.add(RangeAndBearingPart{
      .range_m = 3.0, .height_m = 0.1, .payload = 10, .source = "ARGoS 3; payload: the real robot's interface, too"});
  kind.add(LedsPart{.on_turret = true,
                    .beacon = true,
                    .mounts = ring_and_beacon(),
                    .source = "ARGoS 3: 5 mm outside the body, the first at 15 degrees, one every 30 degrees, "
                              "counter-clockwise; the beacon on the axis"});
  kind.add(TurretPart{.turn_rad_s = 0.5 * kPi,
                      .torque_Nm = 0.5,
                      .source = "chosen: a quarter turn a second; turns another foot-bot that does not drive"});
  kind.add(
      GripperPart{.reach_m = 0.03, .height_m = 0.085, .source = "height: ARGoS 3; reach: chosen, the claws' length"});
  kind.add(ScannerPart{
      .height_m = 0.1232,
      .turn_rad_s = 2.0 * kPi,
      .rate_hz = 60.0,
      .heads = {{0.0, 0.04, 0.30}, {0.5 * kPi, 0.20, 1.50}, {kPi, 0.04, 0.30}, {-0.5 * kPi, 0.20, 1.50}},
      .source =
          "height: ARGoS 3; ranges and rate: the real robot's interface; turn: chosen, twice the 30 turns a minute "
          "that are recommended"});
  kind.add(OmniCameraPart{.height_m = kCameraHeight_m,
                          .aperture_rad = 70.0 * (kPi / 180.0),
                          .source = "ARGoS 3: it looks up into a mirror and sees a disc of the ground"});
  kind.add(CameraPart{.usual = {0.0, kCameraHeight_m, 0.5 * kPi},
                      .front = {kRadius_m, kBeaconHeight_m, 0.0},
                      .aperture_rad = 30.0 * (kPi / 180.0),
                      .focal_length_m = 0.035,
                      .range_m = 2.0,
                      .width_px = 640,
                      .height_px = 480,
                      .attributes_begin = "perspective_camera",
                      .source =
                          "aperture: ARGoS 3; chosen: focal length of a common lens (pixels do not depend on it), "
                          "range (an LED is then seen at about one pixel), VGA as small cameras of its time have"});
  kind.add(ShellPart{.of = std::string(kName), .source = "drawn from memory; sizes as of body and treels"});
  return kind;
}

}  // namespace

/// Tracks beside a dark base, a belt of sensors, the ring that turns with gripper and LEDs, and a tower of boards.
LookPart shell() {
  constexpr std::string_view kDark = "#24282e", kTrack = "#2f3339", kPale = "#d5d9dd";
  LookPart look{.upper = "turret", .whole = true};
  std::vector<Appearance::Link>& all = look.links;
  for (const double y_m : {0.5 * kWheelBase_m, -0.5 * kWheelBase_m}) {
    all.push_back(piece("box", kTrack, {-0.045, y_m - 0.011, 0.004}, {0.045, y_m + 0.011, 0.05}));
    for (const double x_m : {0.045, -0.045})
      all.push_back(piece("wheel", kTrack, {x_m - 0.024, y_m - 0.011, 0.002}, {x_m + 0.024, y_m + 0.011, 0.05}));
    all.push_back(piece("wheel", "#9aa1aa", {-0.029, y_m - 0.013, 0.0}, {0.029, y_m + 0.013, 0.058}));
  }
  all.push_back(piece("cylinder", "#4a515a", {-0.078, -0.056, 0.012}, {0.078, 0.056, 0.055}));
  all.push_back(round_piece("cylinder", kDark, 0.0, 0.0, kRadius_m, 0.052, 0.069));
  const auto turns = [&all](Appearance::Link link) {
    link.on = "turret";
    all.push_back(std::move(link));
  };
  turns(round_piece("cylinder", kPale, 0.0, 0.0, 0.0845, 0.0715, 0.0965));
  turns(round_piece("ring", "#f6f7f5", 0.0, 0.0, 0.0875, 0.08, 0.09));
  turns(piece("box", "#8b939d", {0.06, -0.02, 0.074}, {0.0895, 0.02, 0.095}));
  all.push_back(round_piece("cylinder", "#1f6b45", 0.0, 0.0, 0.07, 0.1, 0.103));
  all.push_back(round_piece("cylinder", "#6d7680", 0.0, 0.0, 0.055, 0.103, 0.135));
  all.push_back(round_piece("cylinder", "#1f6b45", 0.0, 0.0, 0.066, 0.1355, 0.1385));
  all.push_back(round_piece("cylinder", "#e8eaec", 0.0, 0.0, 0.05, 0.1385, 0.1469));
  all.push_back(piece("arrow", kDark, {0.026, -0.02, 0.147}, {0.049, 0.02, 0.1485}));
  all.push_back(round_piece("cylinder", "#f6f7f5", 0.0, 0.0, 0.03, 0.147, kBeaconHeight_m));
  return look;
}

const RobotKind& kind() {
  static const RobotKind made = make();
  return made;
}

}  // namespace tandem::hal::footbot
