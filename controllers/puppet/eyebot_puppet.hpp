// An eye-bot that others control.
#pragma once
#include "controllers/puppet/take_listed.hpp"
#include "hal/controller.hpp"
#include "hal/device/body_sensors.hpp"
#include "hal/device/cameras.hpp"
#include "hal/device/distance_scanner.hpp"
#include "hal/device/flight.hpp"
#include "hal/device/leds.hpp"
#include "hal/device/pan_tilt.hpp"
#include "hal/device/range_and_bearing.hpp"
#include "hal/device/ring_sensors.hpp"

namespace tandem::controllers {

/// Takes what it flies by (task, speed, state, positioning), and whatever else of an eye-bot's devices its
/// configuration lists, and leaves the commands as whoever reaches the ports from outside writes them.
class EyebotPuppet final : public hal::Controller {
 public:
  explicit EyebotPuppet(hal::Robot& robot) {
    robot.actuator<hal::FlightTask>();
    robot.actuator<hal::QuadrotorSpeed>();
    robot.sensor<hal::FlightState>();
    robot.sensor<hal::Positioning>();
    take_listed_sensors<hal::Altimeter, hal::Proximity, hal::Light, hal::DistanceScanner, hal::PanTiltEncoder,
                        hal::PerspectiveCamera, hal::RangeAndBearing, hal::Battery>(robot);
    take_listed_actuators<hal::RingLeds, hal::UpperRingLeds, hal::CameraLed, hal::PanTiltDrive, hal::ScannerDrive,
                          hal::RangeAndBearingSend, hal::QuadrotorPosition, hal::QuadrotorAttitude>(robot);
  }

  void step() noexcept override {}
};

}  // namespace tandem::controllers
