#include "bridges/epuck_emulator/body.hpp"

#include <algorithm>

#include "hal/device/body_sensors.hpp"
#include "hal/device/cliff.hpp"
#include "hal/device/leds.hpp"
#include "hal/device/ring_sensors.hpp"
#include "hal/device/time_of_flight.hpp"
#include "hal/device/wheels.hpp"

namespace tandem::bridges::epuck_emulator {

std::vector<const hal::PortType*> body_ports() {
  return port_types_of<hal::Proximity, hal::Light, hal::Ground, hal::Accelerometer, hal::Microphones, hal::Battery,
                       hal::Gyroscope, hal::TimeOfFlight, hal::Cliff, hal::WheelSpeeds, hal::RingLeds, hal::BodyLed,
                       hal::FrontLed>();
}

void read_body(const PortBank& bank, BodySenses& senses) {
  bank.read<hal::Proximity>([&](const auto& p) { copy_values(p.distance_m, senses.distance_m); });
  bank.read<hal::Light>([&](const auto& p) { copy_values(p.level, senses.light); });
  bank.read<hal::Ground>([&](const auto& p) { copy_values(p.reflectance, senses.ground); });
  bank.read<hal::Accelerometer>([&](const auto& p) { copy_values(p.force_m_s2, senses.force_m_s2); });
  bank.read<hal::Microphones>([&](const auto& p) { copy_values(p.level, senses.sound); });
  bank.read<hal::Gyroscope>([&](const auto& p) { copy_values(p.rate_rad_s, senses.turn_rad_s); });
  bank.read<hal::TimeOfFlight>([&](const auto& p) { senses.ahead_m = static_cast<double>(p.distance_m); });
  bank.read<hal::Cliff>([&](const auto& p) { copy_values(p.reflectance, senses.cliff); });
  bank.read<hal::Battery>([&](const auto& p) { senses.battery_V = static_cast<double>(p.supply_V); });
}

void write_body(PortBank& bank, const BodyCommand& command) {
  bank.port<hal::WheelSpeeds>().set(command.told_left_m_s, command.told_right_m_s);
  auto& ring = bank.port<hal::RingLeds>();
  for (std::size_t i = 0; i < 8; ++i) ring.set(i, ((command.ring >> i) & 1) != 0 ? hal::kRed : hal::kBlack);
  bank.port<hal::BodyLed>().on = command.body_led;
  bank.port<hal::FrontLed>().on = command.front_led;
}

void KinematicBody::look(BodySenses& senses) const {
  senses.turn_rad_s[2] = turn_rad_s();
  see_walls(senses.distance_m);
  senses.ahead_m = std::min(senses.ahead_m, free_m(robot_part<hal::Body>().radius_m, 0.0, pose().heading_rad));
}

}  // namespace tandem::bridges::epuck_emulator
