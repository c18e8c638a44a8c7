// Sources: [ARGoS] ARGoS 3, e-puck plug-in; [GCtronic] e-puck-library and its wiki; [Webots] E-puck.proto. Sensors and
// LEDs are numbered as on the real robot: clockwise from the front, seen from above.
#include "hal/robot/epuck.hpp"

#include <numbers>

#include "hal/device/body_sensors.hpp"
#include "hal/device/brakes.hpp"
#include "hal/device/cameras.hpp"
#include "hal/device/leds.hpp"
#include "hal/device/range_and_bearing.hpp"
#include "hal/device/ring_sensors.hpp"
#include "hal/device/steppers.hpp"
#include "hal/robot/shell.hpp"

namespace tandem::hal::epuck {
namespace {

constexpr double kRadius_m = 0.035;
constexpr double kHeight_m = 0.086;
constexpr double kWheelRadius_m = 0.0205;
constexpr double kWheelBase_m = 0.053;
constexpr double kForce_N = 1.5;
constexpr double kMast_m = 0.122;
constexpr double kStep_m = 2.0 * std::numbers::pi * kWheelRadius_m / 1000;  // a turn has 1000 steps: 20, gear 50:1

constexpr double radians(double deg) {
  return deg * std::numbers::pi / 180.0;
}
constexpr Mount on_rim(double bearing_deg, double cos_b, double sin_b, double radius_m, double z_m) {
  return {radians(bearing_deg), radius_m * cos_b, radius_m * sin_b, z_m};
}

/// ps0 … ps7: front right first, clockwise. They measure distances and ambient light.
std::vector<Mount> infrared() {
  constexpr double kZ_m = 0.03;
  return {on_rim(-17, 0.956304755963035, -0.292371704722737, kRadius_m, kZ_m),
          on_rim(-50, 0.642787609686539, -0.766044443118978, kRadius_m, kZ_m),
          on_rim(-90, 0.0, -1.0, kRadius_m, kZ_m),
          on_rim(-150, -0.866025403784439, -0.5, kRadius_m, kZ_m),
          on_rim(150, -0.866025403784439, 0.5, kRadius_m, kZ_m),
          on_rim(90, 0.0, 1.0, kRadius_m, kZ_m),
          on_rim(50, 0.642787609686539, 0.766044443118978, kRadius_m, kZ_m),
          on_rim(17, 0.956304755963035, 0.292371704722737, kRadius_m, kZ_m)};
}

/// Front first, clockwise, every 45 degrees.
std::vector<Mount> ring_leds() {
  constexpr double kDiag = 0.707106781186548;
  constexpr double kZ_m = 0.04;
  return {on_rim(0, 1, 0, kRadius_m, kZ_m),    on_rim(-45, kDiag, -kDiag, kRadius_m, kZ_m),
          on_rim(-90, 0, -1, kRadius_m, kZ_m), on_rim(-135, -kDiag, -kDiag, kRadius_m, kZ_m),
          on_rim(180, -1, 0, kRadius_m, kZ_m), on_rim(135, -kDiag, kDiag, kRadius_m, kZ_m),
          on_rim(90, 0, 1, kRadius_m, kZ_m),   on_rim(45, kDiag, kDiag, kRadius_m, kZ_m)};
}

/// Measured up to 7 cm; from there a straight line to 0 at the range, so that the curve is strictly falling and can be
/// inverted.
std::vector<InfraredResponse> response() {
  return {{0.0, 4095.0},  {0.005, 2133.33}, {0.01, 1465.73}, {0.015, 601.46}, {0.02, 383.84}, {0.03, 234.93},
          {0.04, 158.03}, {0.05, 120.0},    {0.06, 104.09},  {0.07, 67.19},   {0.1, 0.0}};
}

RangeAndBearingPart board(std::int64_t payload, std::string source) {
  return {.range_m = 0.8, .height_m = kHeight_m, .payload = payload, .source = std::move(source)};
}

RobotKind make() {
  RobotKind kind;
  kind.name = kName;
  kind.summary = "A small robot on two wheels.";
  kind.body = {.radius_m = kRadius_m,
               .height_m = kHeight_m,
               .mass_kg = 0.15,
               .source =
                   "radius: ARGoS 3 and the ROS driver (Webots has 0.0355 to 0.037 m); height: ARGoS 3, with the "
                   "range-and-bearing board; mass: Webots' E-puck.proto"};
  kind.locomotion = DifferentialDrive{
      .wheel_radius_m = kWheelRadius_m,
      .wheel_base_m = kWheelBase_m,
      .max_speed_m_s = 1000 * kStep_m,
      .force_N = kForce_N,
      .torque_Nm = kForce_N * kWheelBase_m / 2,
      .source =
          "wheel radius: GCtronic's wiki (diameter 41 mm); wheel base: ARGoS 3 and the ROS driver; speed: 1000 "
          "steps of 0.1288 mm a second, where the firmware of version 1 clamps; force: what ARGoS 3's engines let "
          "both wheels push with"};
  kind.add(ProximityPart{.range_m = 0.1,
                         .mounts = infrared(),
                         .response = response(),
                         .source = "range: ARGoS 3; bearings: GCtronic's library and Webots, rounded; response: lookup "
                                   "table of Webots' E-puck.proto, ambient offset removed, up to 7 cm; beyond chosen"});
  kind.add(LightPart{{.mounts = infrared(), .source = "the proximity sensors without their own light"}});
  kind.add(GroundPart{{.mounts = {Mount{0, 0.03, -0.009, 0}, Mount{0, 0.03, 0, 0}, Mount{0, 0.03, 0.009, 0}},
                       .source = "ARGoS 3: 30 mm ahead, the first on the right"}});
  kind.add(MicrophonesPart{
      {.mounts = {on_rim(-90, 0, -1, 0.032, 0.04), on_rim(90, 0, 1, 0.032, 0.04), on_rim(180, -1, 0, 0.032, 0.04)},
       .source = "Webots' E-puck.proto: right, left, rear"}});
  kind.add(AccelerometerPart{.source = "GCtronic's library"});
  kind.add(BrakesPart{.deceleration_m_s2 = 5.0,
                      .source = "chosen: stepper motors without a ramp stop at once; within 26 ms, 2 mm, is safe"});
  kind.add(SteppersPart{.steps_per_turn = 1000,
                        .timer_Hz = 10000.0,
                        .source = "GCtronic's library (e_motors.c): a step lasts trunc(10000 / v) periods of 0.1 ms"});
  kind.add(BatteryPart{.full_V = 4.2,
                       .empty_V = 3.4,
                       .low_charge = 0.0,
                       .low_V = 3.4,
                       .source = "GCtronic's library: older boards say \"empty\" below 3.4 V"});
  kind.add(board(2, "ARGoS 3; the board is on top"));
  kind.add(LedsPart{.mounts = ring_leds(), .source = "GCtronic's library; height rounded"});
  kind.add(BodyLedPart{{.mount = {0, 0, 0, 0.03}, .source = "GCtronic's library; height rounded"}});
  kind.add(FrontLedPart{{.mount = on_rim(0, 1, 0, kRadius_m, 0.03), .source = "GCtronic's library; height rounded"}});
  kind.add(ShellPart{.of = std::string(kName), .source = "drawn from memory; sizes as of body and wheels"});
  return kind;
}

}  // namespace

/// A milky body between two wheels, on it the green ring of the main board with its light guide, a speaker, a selector
/// and the board on posts above them.
LookPart shell() {
  constexpr std::string_view kMilk = "#e4e7e2", kBoard = "#1d7a44", kDark = "#202429", kTyre = "#2a2e33";
  LookPart look{.whole = true};
  std::vector<Appearance::Link>& all = look.links;
  all.push_back(piece("cylinder", kMilk, {-0.0335, -0.0225, 0.006}, {0.0335, 0.0225, 0.0375}));
  all.push_back(piece("box", "#c9ccc8", {-0.02, -0.0235, 0.003}, {0.02, 0.0235, 0.012}));
  for (const double y_m : {0.0265, -0.0265}) {
    all.push_back(piece("wheel", kTyre, {-kWheelRadius_m, y_m - 0.003, 0.0}, {kWheelRadius_m, y_m + 0.003, 0.041}));
    all.push_back(piece("wheel", "#8fce5a", {-0.015, y_m - 0.0035, 0.0055}, {0.015, y_m + 0.0035, 0.0355}));
  }
  all.push_back(round_piece("cylinder", kBoard, 0.0, 0.0, kRadius_m, 0.0405, 0.0425));
  all.push_back(round_piece("ring", "#f3f5f2", 0.0, 0.0, 0.0345, 0.0375, 0.0405));
  all.push_back(piece("box", kDark, {0.028, -0.006, 0.02}, {0.0345, 0.006, 0.031}));      // camera
  all.push_back(round_piece("cylinder", "#b9bec4", 0.033, 0.0, 0.0035, 0.0235, 0.0275));  // its lens
  all.push_back(round_piece("cylinder", kDark, -0.006, 0.0, 0.0115, 0.0425, 0.05));       // speaker
  all.push_back(round_piece("cylinder", "#d8b23a", 0.017, 0.013, 0.004, 0.0425, 0.048));  // selector
  all.push_back(piece("box", "#f0c83c", {-0.028, -0.012, 0.0425}, {-0.02, 0.012, 0.049}));
  for (const double x_m : {0.019, -0.019}) {
    for (const double y_m : {0.019, -0.019})
      all.push_back(round_piece("cylinder", "#c7a64a", x_m, y_m, 0.0018, 0.0425, 0.082));
  }
  all.push_back(round_piece("cylinder", kBoard, 0.0, 0.0, 0.03, 0.0815, 0.0835));
  all.push_back(piece("arrow", "#f3f5f2", {-0.01, -0.011, 0.0861}, {0.022, 0.011, 0.0866}));
  return look;
}

const ExtraPart& omnidirectional_camera() {
  static constexpr ExtraPart extra{
      kName, OmnidirectionalCamera::kName, [] {
        return AnyPart(OmniCameraPart{.height_m = kMast_m,
                                      .aperture_rad = radians(70),
                                      .source = "ARGoS' separate e-puck plug-in: aperture and height"});
      }};
  return extra;
}

const ExtraPart& range_and_bearing() {
  static constexpr ExtraPart extra{kName, "epuck_range_and_bearing", [] {
                                     return AnyPart(board(4, "ARGoS' separate e-puck plug-in: size of its packets"));
                                   }};
  return extra;
}

const RobotKind& kind() {
  static const RobotKind made = make();
  return made;
}

}  // namespace tandem::hal::epuck
