// A robot that others control: an emulated firmware, a viewer, a test.
#pragma once
#include "controllers/puppet/take_listed.hpp"
#include "hal/controller.hpp"
#include "hal/device/body_sensors.hpp"
#include "hal/device/cliff.hpp"
#include "hal/device/leds.hpp"
#include "hal/device/ring_sensors.hpp"
#include "hal/device/time_of_flight.hpp"
#include "hal/device/wheels.hpp"

namespace tandem::controllers {

/// Takes every device of an e-puck, and those of an e-puck2 that its configuration lists, and leaves the commands as
/// whoever reaches the ports from outside writes them.
class Puppet final : public hal::Controller {
 public:
  explicit Puppet(hal::Robot& robot) {
    robot.sensor<hal::Proximity>();
    robot.sensor<hal::Light>();
    robot.sensor<hal::Ground>();
    robot.sensor<hal::Accelerometer>();
    robot.sensor<hal::Microphones>();
    robot.sensor<hal::Battery>();
    robot.actuator<hal::WheelSpeeds>();
    robot.actuator<hal::RingLeds>();
    robot.actuator<hal::BodyLed>();
    robot.actuator<hal::FrontLed>();
    take_listed_sensors<hal::Gyroscope, hal::TimeOfFlight, hal::Cliff>(robot);
  }

  void step() noexcept override {}
};

}  // namespace tandem::controllers
