#include "bridges/epuck_emulator/port_body.hpp"

#include <algorithm>

#include "hal/device/body_sensors.hpp"
#include "hal/device/leds.hpp"
#include "hal/device/ring_sensors.hpp"
#include "hal/device/wheels.hpp"

namespace tandem::bridges::epuck_emulator {

std::vector<const hal::PortType*> body_ports() {
  return port_types_of<hal::Proximity, hal::Light, hal::Ground, hal::Accelerometer, hal::Microphones, hal::Battery,
                       hal::WheelSpeeds, hal::RingLeds, hal::BodyLed, hal::FrontLed>();
}

BodySenses PortBody::sense(hal::TimeNs /*now*/) {
  BodySenses senses;
  const auto copy = [](const hal::Reading& port, const auto& from, auto& to) {
    if (port.validity != hal::Validity::Absent) std::copy_n(from.begin(), std::min(from.size(), to.size()), to.begin());
  };
  ports_.with([&](const PortBank& bank) {
    const auto& proximity = bank.port<hal::Proximity>();
    const auto& light = bank.port<hal::Light>();
    const auto& ground = bank.port<hal::Ground>();
    const auto& accelerometer = bank.port<hal::Accelerometer>();
    const auto& microphones = bank.port<hal::Microphones>();
    const auto& battery = bank.port<hal::Battery>();
    copy(proximity, proximity.distance_m, senses.distance_m);
    copy(light, light.level, senses.light);
    copy(ground, ground.reflectance, senses.ground);
    copy(accelerometer, accelerometer.force_m_s2, senses.force_m_s2);
    copy(microphones, microphones.level, senses.sound);
    if (battery.validity != hal::Validity::Absent) senses.battery_V = static_cast<double>(battery.supply_V);
  });
  return senses;
}

void PortBody::actuate(hal::TimeNs /*now*/, const BodyCommand& command) {
  ports_.with([&](PortBank& bank) {
    bank.port<hal::WheelSpeeds>().set(command.left_m_s, command.right_m_s);
    auto& ring = bank.port<hal::RingLeds>();
    for (std::size_t i = 0; i < 8; ++i) ring.set(i, ((command.ring >> i) & 1) != 0 ? hal::kRed : hal::kBlack);
    bank.port<hal::BodyLed>().on = command.body_led;
    bank.port<hal::FrontLed>().on = command.front_led;
  });
}

}  // namespace tandem::bridges::epuck_emulator
