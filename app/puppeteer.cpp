#include "app/puppeteer.hpp"

#include <algorithm>

#include "hal/device/body_sensors.hpp"
#include "hal/device/leds.hpp"
#include "hal/device/ring_sensors.hpp"
#include "hal/device/wheels.hpp"

namespace tandem::app {

hal::Result<core::RobotId> Puppeteer::find(const core::World& world, const std::string& id) {
  const core::Space& space = world.space();
  if (!id.empty()) {
    const core::RobotId robot = space.find_robot(id);
    if (!robot.valid()) return hal::Error{"the arena has no robot '" + id + "'"};
    if (space.port<hal::FrontLed>(robot) == nullptr) {
      return hal::Error{"the controller of robot '" + id +
                        "' is no puppet; give it a configuration <puppet library=\"puppet\" …>"};
    }
    return robot;
  }
  for (std::size_t i = 0; i < space.robot_count(); ++i) {
    const core::RobotId robot = space.robot(i);
    if (space.port<hal::FrontLed>(robot) != nullptr && space.port<hal::Microphones>(robot) != nullptr) return robot;
  }
  return hal::Error{"no robot of the arena is a puppet; give one the controller <puppet library=\"puppet\" …>"};
}

void Puppeteer::after_sense(core::World& world) {
  const core::Space& space = world.space();
  if (!space.contains(robot_)) return;  // a hook took it away: its firmware goes on without a body
  bridges::epuck_emulator::BodySenses senses;
  const auto copy = [](const auto& from, auto& to) {
    std::copy_n(from.begin(), std::min(from.size(), to.size()), to.begin());
  };
  copy(space.port<hal::Proximity>(robot_)->distance_m, senses.distance_m);
  copy(space.port<hal::Light>(robot_)->level, senses.light);
  copy(space.port<hal::Ground>(robot_)->reflectance, senses.ground);
  copy(space.port<hal::Accelerometer>(robot_)->force_m_s2, senses.force_m_s2);
  copy(space.port<hal::Microphones>(robot_)->level, senses.sound);
  senses.battery_V = static_cast<double>(space.port<hal::Battery>(robot_)->supply_V);
  body_.set_senses(senses);
}

void Puppeteer::after_filter(core::World& world) {
  core::Space& space = world.space();
  if (!space.contains(robot_)) return;
  const bridges::epuck_emulator::BodyCommand command = body_.command();
  space.port<hal::WheelSpeeds>(robot_)->set(command.left_m_s, command.right_m_s);
  auto* ring = space.port<hal::RingLeds>(robot_);
  for (std::size_t i = 0; i < 8; ++i) ring->set(i, ((command.ring >> i) & 1) != 0 ? hal::kRed : hal::kBlack);
  space.port<hal::BodyLed>(robot_)->on = command.body_led;
  space.port<hal::FrontLed>(robot_)->on = command.front_led;
}

}  // namespace tandem::app
