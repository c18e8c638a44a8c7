#include "app/footbot_puppeteer.hpp"

#include <algorithm>
#include <limits>

#include "hal/device/body_sensors.hpp"
#include "hal/device/distance_scanner.hpp"
#include "hal/device/gripper.hpp"
#include "hal/device/leds.hpp"
#include "hal/device/range_and_bearing.hpp"
#include "hal/device/ring_sensors.hpp"
#include "hal/device/turret.hpp"
#include "hal/device/wheels.hpp"

namespace tandem::app {
namespace {

namespace emulator = bridges::footbot_emulator;

template <class From, class To>
void copy(const From& from, To& to) {
  std::copy_n(from.begin(), std::min(from.size(), to.size()), to.begin());
}

/// The newest measurement of each head.
void read_scanner(const hal::DistanceScanner& scanner, emulator::BodySenses& senses) {
  senses.scanner_rad = static_cast<double>(scanner.turn_rad);
  for (std::size_t head = 0; head < senses.scan_m.size() && scanner.samples > 0; ++head) {
    const std::size_t last = scanner.samples - 1;
    if (!scanner.sees_nothing(head, last)) senses.scan_m[head] = static_cast<double>(scanner.distance(head, last));
  }
}

std::vector<emulator::Heard> heard_by(const hal::RangeAndBearing& radio) {
  std::vector<emulator::Heard> all(radio.count);
  for (std::size_t i = 0; i < all.size(); ++i) {
    all[i].range_m = static_cast<double>(radio.range_m[i]);
    all[i].bearing_rad = static_cast<double>(radio.bearing_rad[i]);
    all[i].elevation_rad = static_cast<double>(radio.elevation_rad[i]);
    std::copy_n(radio.message(i), std::min<std::size_t>(radio.size[i], emulator::kRadioBytes), all[i].payload.begin());
  }
  return all;
}

bool fits(const core::Space& space, core::RobotId robot) {
  return space.data_sheet(robot).kind == hal::footbot::kDataSheet.kind &&
         space.port<hal::WheelSpeeds>(robot) != nullptr;
}

}  // namespace

hal::Result<core::RobotId> FootbotPuppeteer::find(const core::World& world, const std::string& id) {
  const core::Space& space = world.space();
  if (!id.empty()) {
    const core::RobotId robot = space.find_robot(id);
    if (!robot.valid()) return hal::Error{"the arena has no robot '" + id + "'"};
    if (!fits(space, robot)) {
      return hal::Error{"robot '" + id +
                        "' is no foot-bot, or its controller takes no wheels; give it a configuration "
                        "<footbot_puppet library=\"puppet\" …>"};
    }
    return robot;
  }
  for (std::size_t i = 0; i < space.robot_count(); ++i) {
    if (fits(space, space.robot(i))) return space.robot(i);
  }
  return hal::Error{
      "the arena has no foot-bot with wheels; give one the controller <footbot_puppet library=\"puppet\" …>"};
}

void FootbotPuppeteer::after_sense(core::World& world) {
  const core::Space& space = world.space();
  if (!space.contains(robot_)) return;  // a hook took it away: its modules go on without a body
  emulator::BodySenses senses;
  std::vector<emulator::Heard> heard;
  const auto with = [&]<class Port>(auto read) {
    if (const auto* port = space.port<Port>(robot_)) read(*port);
  };
  with.operator()<hal::Proximity>([&](const auto& p) { copy(p.distance_m, senses.distance_m); });
  with.operator()<hal::Light>([&](const auto& p) { copy(p.level, senses.light); });
  with.operator()<hal::BaseGround>([&](const auto& p) { copy(p.reflectance, senses.base_ground); });
  with.operator()<hal::MotorGround>([&](const auto& p) { copy(p.reflectance, senses.motor_ground); });
  with.operator()<hal::DistanceScanner>([&](const auto& p) { read_scanner(p, senses); });
  with.operator()<hal::TurretEncoder>([&](const auto& p) { senses.turret_rad = p.angle_rad; });
  with.operator()<hal::Gripper>([&](const auto& p) {
    // Claws that hold nothing are closed again when the robot has tried its grip.
    senses.gripper_rad = p.holding || p.busy ? static_cast<double>(p.aperture_rad) : 0.0;
    senses.gripper_busy = p.busy;
  });
  with.operator()<hal::Battery>([&](const auto& p) { senses.battery_V = static_cast<double>(p.supply_V); });
  with.operator()<hal::Accelerometer>([&](const auto& p) { copy(p.force_m_s2, senses.force_m_s2); });
  with.operator()<hal::Gyroscope>([&](const auto& p) { senses.turn_rad_s = static_cast<double>(p.rate_rad_s[2]); });
  with.operator()<hal::RangeAndBearing>([&](const auto& p) { heard = heard_by(p); });
  body_.set_senses(senses, heard);
}

void FootbotPuppeteer::after_filter(core::World& world) {
  core::Space& space = world.space();
  if (!space.contains(robot_)) return;
  const emulator::BodyCommand command = body_.command();
  const auto with = [&]<class Port>(auto write) {
    if (auto* port = space.port<Port>(robot_)) write(*port);
  };
  with.operator()<hal::WheelSpeeds>([&](auto& p) { p.set(command.left_m_s, command.right_m_s); });
  with.operator()<hal::RingLeds>([&](auto& p) { copy(command.rgb, p.rgb); });
  with.operator()<hal::TurretDrive>([&](auto& p) {
    p.mode = static_cast<hal::TurretMode>(command.turret);
    p.speed_rad_s = command.turret_rad_s;
    p.angle_rad = command.turret_rad;
  });
  with.operator()<hal::GripperDrive>([&](auto& p) { p.aperture_rad = command.gripper_rad; });
  with.operator()<hal::ScannerDrive>([&](auto& p) {
    p.mode = static_cast<hal::ScannerMode>(command.scanner);
    p.speed_rad_s = command.scanner_rad_s;
    p.angle_rad = command.scanner_rad;
  });
  with.operator()<hal::RangeAndBearingSend>([&](auto& p) {
    p.sending = command.radio_sends;
    p.size = static_cast<std::uint8_t>(emulator::kRadioBytes);
    copy(command.radio, p.payload);
  });
}

}  // namespace tandem::app
