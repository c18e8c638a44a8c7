// Controller of a robot on wheels whose commands come from outside.
#pragma once
#include "controllers/puppet/take_listed.hpp"
#include "hal/controller.hpp"
#include "hal/device/body_sensors.hpp"
#include "hal/device/buttons.hpp"
#include "hal/device/cameras.hpp"
#include "hal/device/distance_scanner.hpp"
#include "hal/device/gripper.hpp"
#include "hal/device/leds.hpp"
#include "hal/device/range_and_bearing.hpp"
#include "hal/device/ring_sensors.hpp"
#include "hal/device/speaker.hpp"
#include "hal/device/turret.hpp"
#include "hal/device/wheels.hpp"

namespace tandem::controllers {

/// Takes the wheels, and whatever else of its devices its configuration lists, and leaves the commands as whoever
/// reaches the ports from outside writes them.
class WheeledPuppet : public hal::Controller {
 public:
  explicit WheeledPuppet(hal::Robot& robot) {
    robot.actuator<hal::WheelSpeeds>();
    take_listed_sensors<hal::Proximity, hal::Light, hal::Ground, hal::Microphones, hal::BaseGround, hal::MotorGround,
                        hal::DistanceScanner, hal::TurretEncoder, hal::Gripper, hal::RangeAndBearing, hal::Battery,
                        hal::Accelerometer, hal::Gyroscope, hal::Buttons, hal::WheelEncoders,
                        hal::OmnidirectionalCamera, hal::PerspectiveCamera>(robot);
    take_listed_actuators<hal::RingLeds, hal::TurretDrive, hal::GripperDrive, hal::ScannerDrive,
                          hal::RangeAndBearingSend, hal::Speaker>(robot);
  }

  void step() noexcept override {}
};

// One class for each name: a class of controllers has one.
class FootbotPuppet final : public WheeledPuppet {
 public:
  using WheeledPuppet::WheeledPuppet;
};
class ThymioPuppet final : public WheeledPuppet {
 public:
  using WheeledPuppet::WheeledPuppet;
};

}  // namespace tandem::controllers
