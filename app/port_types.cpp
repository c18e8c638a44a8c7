#include "app/port_types.hpp"

#include "hal/device/body_sensors.hpp"
#include "hal/device/cameras.hpp"
#include "hal/device/distance_scanner.hpp"
#include "hal/device/flight.hpp"
#include "hal/device/gripper.hpp"
#include "hal/device/leds.hpp"
#include "hal/device/pan_tilt.hpp"
#include "hal/device/range_and_bearing.hpp"
#include "hal/device/ring_sensors.hpp"
#include "hal/device/turret.hpp"
#include "hal/device/wheels.hpp"

namespace tandem::app {

std::span<const hal::PortType* const> all_port_types() {
  static const hal::PortType* const ports[] = {&hal::port_type<hal::WheelSpeeds>(),
                                               &hal::port_type<hal::WheelEncoders>(),
                                               &hal::port_type<hal::Proximity>(),
                                               &hal::port_type<hal::Light>(),
                                               &hal::port_type<hal::Ground>(),
                                               &hal::port_type<hal::Accelerometer>(),
                                               &hal::port_type<hal::Microphones>(),
                                               &hal::port_type<hal::Battery>(),
                                               &hal::port_type<hal::Clock>(),
                                               &hal::port_type<hal::RingLeds>(),
                                               &hal::port_type<hal::BodyLed>(),
                                               &hal::port_type<hal::FrontLed>(),
                                               &hal::port_type<hal::RangeAndBearing>(),
                                               &hal::port_type<hal::RangeAndBearingSend>(),
                                               &hal::port_type<hal::QuadrotorPosition>(),
                                               &hal::port_type<hal::QuadrotorSpeed>(),
                                               &hal::port_type<hal::Positioning>(),
                                               &hal::port_type<hal::Odometry>(),
                                               &hal::port_type<hal::Gyroscope>(),
                                               &hal::port_type<hal::BaseGround>(),
                                               &hal::port_type<hal::MotorGround>(),
                                               &hal::port_type<hal::TurretDrive>(),
                                               &hal::port_type<hal::TurretEncoder>(),
                                               &hal::port_type<hal::GripperDrive>(),
                                               &hal::port_type<hal::Gripper>(),
                                               &hal::port_type<hal::ScannerDrive>(),
                                               &hal::port_type<hal::DistanceScanner>(),
                                               &hal::port_type<hal::OmnidirectionalCamera>(),
                                               &hal::port_type<hal::PerspectiveCamera>(),
                                               &hal::port_type<hal::UpperRingLeds>(),
                                               &hal::port_type<hal::QuadrotorAttitude>(),
                                               &hal::port_type<hal::FlightTask>(),
                                               &hal::port_type<hal::FlightState>(),
                                               &hal::port_type<hal::Altimeter>(),
                                               &hal::port_type<hal::CameraLed>(),
                                               &hal::port_type<hal::PanTiltDrive>(),
                                               &hal::port_type<hal::PanTiltEncoder>()};
  return ports;
}

}  // namespace tandem::app
