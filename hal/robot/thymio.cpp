// Sources: [Enki] the model of the Thymio II in the simulator of ASEBA's playground, enki/robots/thymio2/Thymio2.cpp;
// [API] the Thymio's programming interface, thymio.org; chosen: no figure is published, the reason stands beside. The
// origin lies between the wheels, which sit behind the middle of the body. Sensors are numbered as in the robot's
// variables.
#include "hal/robot/thymio.hpp"

#include <numbers>
#include <utility>

#include "hal/angle.hpp"
#include "hal/device/body_sensors.hpp"
#include "hal/device/brakes.hpp"
#include "hal/device/buttons.hpp"
#include "hal/device/leds.hpp"
#include "hal/device/ring_sensors.hpp"
#include "hal/device/speaker.hpp"
#include "hal/robot/ring.hpp"
#include "hal/robot/shell.hpp"

namespace tandem::hal::thymio {
namespace {

constexpr double kWheelBase_m = 0.094;
constexpr double kForce_N = 1.5;
constexpr double kHeight_m = 0.051;
constexpr double kRange_m = 0.14;
constexpr double kButtons_m = 0.048;  // the middle of the buttons and the circle of LEDs, ahead of the axis

/// Front, from left to right, then back left and back right.
std::vector<Mount> infrared() {
  constexpr double kPi = std::numbers::pi;
  constexpr double kZ_m = 0.034;
  return {{0.69813, 0.062, 0.0485, kZ_m},   {0.34906, 0.075, 0.0255, kZ_m},   {0.0, 0.0795, 0.0, kZ_m},
          {-0.34906, 0.075, -0.0255, kZ_m}, {-0.69813, 0.062, -0.0485, kZ_m}, {kPi, -0.0295, 0.0295, kZ_m},
          {kPi, -0.0295, -0.0295, kZ_m}};
}

/// m (c - x0^2) / (x^2 - 2 x0 x + c) with m = 4505, x0 = 0.03 cm, c = 73 cm^2, x in cm; beyond the range nothing.
std::vector<InfraredResponse> response() {
  std::vector<InfraredResponse> points;
  const auto counts = [](double x_cm) { return 4505.0 * (73.0 - 0.03 * 0.03) / (x_cm * x_cm - 0.06 * x_cm + 73.0); };
  points.push_back({0.0, 4505.0});
  for (double x_cm : {0.5, 1.0, 1.5, 2.0, 3.0, 4.0, 5.0, 6.0, 7.0, 8.0, 9.0, 10.0, 11.0, 12.0, 13.0, 13.99})
    points.push_back({0.01 * x_cm, counts(x_cm)});
  points.push_back({kRange_m, 0.0});
  return points;
}

std::vector<Mount> leds() {
  std::vector<Mount> all;
  for (const Mount& m : ring_of(kCircleLeds, 0.0, 0.022, kHeight_m)) {
    all.push_back({wrapped(-m.bearing_rad), kButtons_m + m.x_m, -m.y_m, m.z_m});  // clockwise
  }
  constexpr double kLeft = 0.5 * std::numbers::pi;
  all.push_back({kLeft, 0.0, 0.055, 0.015});
  all.push_back({-kLeft, 0.0, -0.055, 0.015});
  all.push_back({0.0, 0.0, 0.0, kHeight_m});
  return all;
}

RobotKind make() {
  RobotKind kind;
  kind.name = kName;
  kind.summary = "The Thymio II, a robot for schools on two wheels.";
  kind.body = {.radius_m = 0.08,
               .height_m = kHeight_m,
               .mass_kg = 0.2,
               .source =
                   "Enki: the front is an arc of this radius around the point between the wheels; behind, the real "
                   "robot ends 3 cm and to the sides 5.5 cm from there, and this cylinder does not"};
  kind.locomotion = DifferentialDrive{
      .wheel_radius_m = 0.022,
      .wheel_base_m = kWheelBase_m,
      .max_speed_m_s = 0.2,
      .force_N = kForce_N,
      .torque_Nm = kForce_N * kWheelBase_m / 2,
      .source =
          "wheel base: Enki; speed: API, about 20 cm/s at 500 (Enki has 16.6); wheel radius: rounded, nothing "
          "depends on it; force: chosen, the e-puck's"};
  kind.add(ProximityPart{.range_m = kRange_m,
                         .mounts = infrared(),
                         .response = response(),
                         .source = "Enki, places and response; the firmware says 0 where nothing is within range"});
  kind.add(GroundPart{
      {.mounts = {Mount{0, 0.072, 0.012, 0}, Mount{0, 0.072, -0.012, 0}}, .source = "Enki: the first on the left"}});
  kind.add(AccelerometerPart{.source = "API: 16 Hz, 23 counts are 9.81 m/s2"});
  kind.add(BrakesPart{.deceleration_m_s2 = 2.0, .source = "chosen: its control of speed stops it within 0.1 s, 1 cm"});
  kind.add(MicrophonesPart{{.mounts = {Mount{0, kButtons_m, 0, kHeight_m}},
                            .source = "API: one, its level; place: chosen, beside the buttons"}});
  kind.add(ButtonsPart{.count = 5, .source = "API: backward, left, center, forward, right"});
  kind.add(SpeakerPart{.source = "API: tones by their frequency"});
  kind.add(LedsPart{.beacon = true,
                    .mounts = leds(),
                    .source =
                        "API: eight in a circle around the buttons (yellow alone), clockwise from the front; below "
                        "left, below right, on top (all colours); places: Enki's pictures, rounded"});
  kind.add(ShellPart{.of = std::string(kName), .source = "drawn from memory; outline: Enki"});
  return kind;
}

}  // namespace

/// A white box, flat behind and round ahead, with five buttons, studs for bricks, a hole for a pen, and dark windows
/// before its sensors.
LookPart shell() {
  constexpr std::string_view kWhite = "#f4f5f2", kPale = "#b9bfc6", kDark = "#1c1f23";
  constexpr double kTop_m = kHeight_m - 0.001;
  LookPart look{.whole = true};
  std::vector<Appearance::Link>& all = look.links;
  all.push_back(piece("shield", kWhite, {-0.03, -0.055, 0.008}, {0.08, 0.055, kTop_m}));
  all.push_back(piece("shield", "#d9dcd8", {-0.028, -0.053, 0.004}, {0.077, 0.053, 0.008}));
  for (const double side : {1.0, -1.0}) {
    const double y_m = 0.5 * side * kWheelBase_m;
    all.push_back(piece("wheel", "#3a3e44", {-0.022, y_m - 0.0095, 0.0}, {0.022, y_m + 0.0095, 0.044}));
    all.push_back(piece("box", kDark, {-0.024, side * 0.0505 - 0.005, 0.003}, {0.024, side * 0.0505 + 0.005, 0.03}));
    all.push_back(
        piece("wheel", "#dfe2e0", {-0.02, side * 0.0558 - 0.001, 0.002}, {0.02, side * 0.0558 + 0.001, 0.042}));
    all.push_back(
        piece("wheel", "#3a3e44", {-0.007, side * 0.0568 - 0.001, 0.015}, {0.007, side * 0.0568 + 0.001, 0.029}));
  }
  for (const auto& [x_m, y_m] : {std::pair{0.014, 0.0}, {-0.014, 0.0}, {0.0, 0.014}, {0.0, -0.014}}) {
    all.push_back(piece("arrow", kPale, {kButtons_m + x_m - 0.0055, y_m - 0.006, kTop_m},
                        {kButtons_m + x_m + 0.0055, y_m + 0.006, kTop_m + 0.0015}));
    all.back().turned_rad = x_m > 0.0   ? 0.0
                            : x_m < 0.0 ? std::numbers::pi
                            : y_m > 0.0 ? 0.5 * std::numbers::pi
                                        : -0.5 * std::numbers::pi;
  }
  all.push_back(round_piece("cylinder", kPale, kButtons_m, 0.0, 0.005, kTop_m, kTop_m + 0.0015));
  all.push_back(round_piece("cylinder", kDark, 0.0, 0.0, 0.0055, kTop_m - 0.001, kTop_m + 0.0004));  // for a pen
  for (const double x_m : {-0.022, -0.014}) {
    for (const double y_m : {0.044, 0.036, -0.036, -0.044})
      all.push_back(round_piece("cylinder", kWhite, x_m, y_m, 0.0025, kTop_m, kTop_m + 0.002));
  }
  for (const Mount& m : infrared()) {
    all.push_back(piece("box", kDark, {m.x_m - 0.002, m.y_m - 0.007, m.z_m - 0.005},
                        {m.x_m + 0.0015, m.y_m + 0.007, m.z_m + 0.005}));
    all.back().turned_rad = m.bearing_rad;
  }
  return look;
}

const RobotKind& kind() {
  static const RobotKind made = make();
  return made;
}

}  // namespace tandem::hal::thymio
