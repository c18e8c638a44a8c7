#include "bridges/eyebot/robot.hpp"

#include "hal/device/body_sensors.hpp"
#include "hal/device/cameras.hpp"
#include "hal/device/distance_scanner.hpp"
#include "hal/device/flight.hpp"
#include "hal/device/leds.hpp"
#include "hal/device/pan_tilt.hpp"
#include "hal/device/range_and_bearing.hpp"
#include "hal/device/ring_sensors.hpp"

namespace tandem::bridges::eyebot {

const std::vector<const hal::PortType*>& port_types() {
  static const auto all =
      port_types_of<hal::Positioning, hal::FlightState, hal::Altimeter, hal::Gyroscope, hal::Proximity, hal::Light,
                    hal::DistanceScanner, hal::PerspectiveCamera, hal::PanTiltEncoder, hal::RangeAndBearing,
                    hal::Battery, hal::Clock, hal::QuadrotorPosition, hal::QuadrotorSpeed, hal::FlightTask,
                    hal::RingLeds, hal::UpperRingLeds, hal::CameraLed, hal::PanTiltDrive, hal::ScannerDrive,
                    hal::RangeAndBearingSend>();
  return all;
}

}  // namespace tandem::bridges::eyebot
