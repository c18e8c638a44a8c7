// Sources: [GCtronic] the e-puck2's wiki and its firmware, e-puck2_main-processor; [Webots] E-puck.proto; data sheets
// of the chips. What is not said here is as with the e-puck.
#include "hal/robot/epuck2.hpp"

#include <numbers>

#include "hal/device/body_sensors.hpp"
#include "hal/device/cliff.hpp"
#include "hal/device/selector.hpp"
#include "hal/device/steppers.hpp"
#include "hal/device/time_of_flight.hpp"
#include "hal/robot/epuck.hpp"

namespace tandem::hal::epuck2 {
namespace {

constexpr double kMostSteps_s = 1100.0;
constexpr double kStepsPerTurn = 1000.0;

RobotKind make() {
  RobotKind kind = epuck::kind();
  kind.name = kName;
  kind.summary = "A small robot on two wheels, version 2: with gyroscope, time of flight, cliff sensors and selector.";
  const double radius_m = kind.body.radius_m;
  kind.body.mass_kg = 0.13;
  kind.body.source += "; mass: GCtronic's wiki";
  DifferentialDrive& drive = *kind.part<DifferentialDrive>();
  drive.max_speed_m_s = 2.0 * std::numbers::pi * drive.wheel_radius_m * kMostSteps_s / kStepsPerTurn;
  drive.source =
      "wheels as the e-puck's; speed: 1100 steps of 0.1288 mm a second, where the firmware clamps; force: as the "
      "e-puck's";
  kind.remove(SteppersPart::kName);  // its timer is finer
  kind.part<AccelerometerPart>()->source = "GCtronic's firmware: MPU-9250, or ICM-20948 on newer boards";
  MicrophonesPart& microphones = *kind.part<MicrophonesPart>();
  microphones.mounts.push_back({0.0, 0.032, 0.0, 0.04});
  microphones.source = "GCtronic's firmware: right, left, rear, front; places as the e-puck's";
  kind.add(
      GyroscopePart{.source = "GCtronic's firmware: MPU-9250, or ICM-20948 on newer boards; 250 degrees a second"});
  kind.add(TimeOfFlightPart{.mount = {0.0, radius_m, 0.0, 0.033},
                            .range_m = 2.0,
                            .cone_rad = 25.0 * std::numbers::pi / 180.0,
                            .source = "range: GCtronic's wiki; cone: data sheet of ST's VL53L0X; height chosen"});
  kind.add(
      CliffPart{{.mounts = {Mount{0, 0.025, -0.02, 0}, Mount{0, 0.025, 0.02, 0}},
                 .source = "GCtronic's ground sensors with cliff sensors: the right one first; places chosen, for no "
                           "drawing of the board is known"}});
  kind.add(SelectorPart{.source = "GCtronic's wiki: 16 positions; 3, 8, 10 and 15 choose how the robot is reached"});
  return kind;
}

}  // namespace

const RobotKind& kind() {
  static const RobotKind made = make();
  return made;
}

}  // namespace tandem::hal::epuck2
