#include "bridges/footbot_emulator/body.hpp"

#include "hal/device/body_sensors.hpp"
#include "hal/device/distance_scanner.hpp"
#include "hal/device/gripper.hpp"
#include "hal/device/leds.hpp"
#include "hal/device/range_and_bearing.hpp"
#include "hal/device/ring_sensors.hpp"
#include "hal/device/turret.hpp"
#include "hal/device/wheels.hpp"

namespace tandem::bridges::footbot_emulator {
namespace {

/// The newest measurement of each head.
void read_scanner(const hal::DistanceScanner& scanner, BodySenses& senses) {
  senses.scanner_rad = static_cast<double>(scanner.turn_rad);
  for (std::size_t head = 0; head < senses.scan_m.size() && scanner.samples > 0; ++head) {
    const std::size_t last = scanner.samples - 1;
    if (!scanner.sees_nothing(head, last)) senses.scan_m[head] = static_cast<double>(scanner.distance(head, last));
  }
}

}  // namespace

std::vector<const hal::PortType*> body_ports() {
  return port_types_of<hal::Proximity, hal::Light, hal::BaseGround, hal::MotorGround, hal::DistanceScanner,
                       hal::TurretEncoder, hal::Gripper, hal::Battery, hal::Accelerometer, hal::Gyroscope,
                       hal::RangeAndBearing, hal::WheelSpeeds, hal::RingLeds, hal::TurretDrive, hal::GripperDrive,
                       hal::ScannerDrive, hal::RangeAndBearingSend>();
}

void read_body(const PortBank& bank, BodySenses& senses) {
  bank.read<hal::Proximity>([&](const auto& p) { copy_values(p.distance_m, senses.distance_m); });
  bank.read<hal::Light>([&](const auto& p) { copy_values(p.level, senses.light); });
  bank.read<hal::BaseGround>([&](const auto& p) { copy_values(p.reflectance, senses.base_ground); });
  bank.read<hal::MotorGround>([&](const auto& p) { copy_values(p.reflectance, senses.motor_ground); });
  bank.read<hal::DistanceScanner>([&](const auto& p) { read_scanner(p, senses); });
  bank.read<hal::TurretEncoder>([&](const auto& p) { senses.turret_rad = p.angle_rad; });
  bank.read<hal::Gripper>([&](const auto& p) {
    // Claws that hold nothing are closed again when the robot has tried its grip.
    senses.gripper_rad = p.holding || p.busy ? static_cast<double>(p.aperture_rad) : 0.0;
    senses.gripper_busy = p.busy;
  });
  bank.read<hal::Battery>([&](const auto& p) { senses.battery_V = static_cast<double>(p.supply_V); });
  bank.read<hal::Accelerometer>([&](const auto& p) { copy_values(p.force_m_s2, senses.force_m_s2); });
  bank.read<hal::Gyroscope>([&](const auto& p) { senses.turn_rad_s = static_cast<double>(p.rate_rad_s[2]); });
}

void write_body(PortBank& bank, const BodyCommand& command) {
  bank.port<hal::WheelSpeeds>().set(command.left_m_s, command.right_m_s);
  copy_values(command.rgb, bank.port<hal::RingLeds>().rgb);
  auto& turret = bank.port<hal::TurretDrive>();
  turret.mode = static_cast<hal::TurretMode>(command.turret);
  turret.speed_rad_s = command.turret_rad_s;
  turret.angle_rad = command.turret_rad;
  bank.port<hal::GripperDrive>().aperture_rad = command.gripper_rad;
  write_scanner(bank, command);
  auto& radio = bank.port<hal::RangeAndBearingSend>();
  radio.sending = command.radio_sends;
  radio.size = static_cast<std::uint8_t>(kRadioBytes);
  copy_values(command.radio, radio.payload);
}

}  // namespace tandem::bridges::footbot_emulator
