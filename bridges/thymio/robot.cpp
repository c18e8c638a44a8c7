#include "bridges/thymio/robot.hpp"

#include "hal/device/body_sensors.hpp"
#include "hal/device/buttons.hpp"
#include "hal/device/leds.hpp"
#include "hal/device/ring_sensors.hpp"
#include "hal/device/speaker.hpp"
#include "hal/device/wheels.hpp"

namespace tandem::bridges::thymio {

const std::vector<const hal::PortType*>& port_types() {
  static const auto all =
      port_types_of<hal::WheelEncoders, hal::Odometry, hal::Proximity, hal::Ground, hal::Accelerometer,
                    hal::Microphones, hal::Buttons, hal::Clock, hal::WheelSpeeds, hal::RingLeds, hal::Speaker>();
  return all;
}

ThymioRobot::ThymioRobot(RobotSettings settings)
    : BridgedRobot("Thymio", hal::thymio::kind(), std::move(settings), port_types()),
      reckoning_(kind().drive() != nullptr ? kind().drive()->wheel_base_m : 0.0) {
  if (const auto* const part = kind().part<hal::ProximityPart>(); part != nullptr)
    port<hal::Proximity>().range_m = static_cast<float>(part->range_m);
}

bool ThymioRobot::uses(const hal::PortType& type) const noexcept {
  const bool reckons =
      &type == &hal::port_type<hal::WheelEncoders>() && BridgedRobot::uses(hal::port_type<hal::Odometry>());
  return reckons || BridgedRobot::uses(type);
}

void ThymioRobot::complete(hal::Tick tick) noexcept {
  tell_time(tick);
  reckoning_.follow(port<hal::WheelEncoders>(), port<hal::Odometry>());
}

}  // namespace tandem::bridges::thymio
