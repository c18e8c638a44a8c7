#include "bridges/thymio_emulator/body.hpp"

#include "hal/device/body_sensors.hpp"
#include "hal/device/buttons.hpp"
#include "hal/device/leds.hpp"
#include "hal/device/ring_sensors.hpp"
#include "hal/device/speaker.hpp"
#include "hal/device/wheels.hpp"

namespace tandem::bridges::thymio_emulator {

std::vector<const hal::PortType*> body_ports() {
  return port_types_of<hal::Proximity, hal::Ground, hal::Accelerometer, hal::Microphones, hal::Buttons,
                       hal::WheelSpeeds, hal::RingLeds, hal::Speaker>();
}

void read_body(const PortBank& bank, BodySenses& senses) {
  bank.read<hal::Proximity>([&](const auto& p) { copy_values(p.distance_m, senses.distance_m); });
  bank.read<hal::Ground>([&](const auto& p) { copy_values(p.reflectance, senses.ground); });
  bank.read<hal::Accelerometer>([&](const auto& p) { copy_values(p.force_m_s2, senses.force_m_s2); });
  bank.read<hal::Buttons>([&](const auto& p) { copy_values(p.pressed, senses.buttons); });
  bank.read<hal::Microphones>([&](const auto& p) { senses.sound = static_cast<double>(p.level[0]); });
}

void write_body(PortBank& bank, const BodyCommand& command) {
  bank.port<hal::WheelSpeeds>().set(command.left_m_s, command.right_m_s);
  copy_values(command.rgb, bank.port<hal::RingLeds>().rgb);
  bank.port<hal::Speaker>().tone_Hz = static_cast<float>(command.tone_Hz);
}

}  // namespace tandem::bridges::thymio_emulator
