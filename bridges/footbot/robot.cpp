#include "bridges/footbot/robot.hpp"

#include <algorithm>
#include <cmath>

#include "hal/angle.hpp"
#include "hal/device/body_sensors.hpp"
#include "hal/device/distance_scanner.hpp"
#include "hal/device/gripper.hpp"
#include "hal/device/leds.hpp"
#include "hal/device/range_and_bearing.hpp"
#include "hal/device/ring_sensors.hpp"
#include "hal/device/turret.hpp"
#include "hal/device/wheels.hpp"

namespace tandem::bridges::footbot {
namespace {

bool feeds(const FootbotMap& map, const hal::PortType& type, std::string_view field = {}) {
  const auto is = [&](const FieldMap& f) { return f.port == &type && (field.empty() || f.field->name == field); };
  for (const NodeMap& node : map.nodes) {
    for (const VariableMap& v : node.variables) {
      if (std::ranges::any_of(v.reads, is) || std::ranges::any_of(v.writes, is)) return true;
    }
    if (!node.packets.empty() && &type == &hal::port_type<hal::RangeAndBearing>()) return true;
  }
  return false;
}

}  // namespace

const std::vector<const hal::PortType*>& port_types() {
  static const auto all =
      port_types_of<hal::WheelEncoders, hal::Odometry, hal::Proximity, hal::Light, hal::BaseGround, hal::MotorGround,
                    hal::DistanceScanner, hal::TurretEncoder, hal::Gripper, hal::RangeAndBearing, hal::Battery,
                    hal::Accelerometer, hal::Gyroscope, hal::Clock, hal::WheelSpeeds, hal::RingLeds, hal::ScannerDrive,
                    hal::TurretDrive, hal::GripperDrive, hal::RangeAndBearingSend>();
  return all;
}

FootbotRobot::FootbotRobot(RobotSettings settings, const FootbotMap& map)
    : NodeRobot("foot-bot", hal::footbot::kind(), std::move(settings), port_types()),
      heads_(kind().part<hal::ScannerPart>()) {
  const bool counts = feeds(map, hal::port_type<hal::WheelEncoders>());
  for (const hal::PortType* type : port_types()) {
    const bool made_here =
        type == &hal::port_type<hal::Clock>() || (counts && type == &hal::port_type<hal::Odometry>());
    if (!made_here && !feeds(map, *type))
      leave_out(*type, " in its map: no variable there is for it; add it to the map");
  }
  tells_holding_ = feeds(map, hal::port_type<hal::Gripper>(), "holding");
  auto& scanner = port<hal::DistanceScanner>();
  if (heads_ != nullptr) {
    scanner.short_min_m = static_cast<float>(heads_->heads[0].min_m);
    scanner.short_max_m = static_cast<float>(heads_->heads[0].max_m);
    scanner.long_min_m = static_cast<float>(heads_->heads[1].min_m);
    scanner.long_max_m = static_cast<float>(heads_->heads[1].max_m);
  }
  // Heads that no variable of the map tells of see nothing, not something at 0 m.
  for (std::size_t head = 0; head < hal::DistanceScanner::kHeads; ++head) {
    scanner.distance_m[head] = hal::DistanceScanner::is_short(head) ? scanner.short_max_m : scanner.long_max_m;
  }
}

void FootbotRobot::complete(hal::Tick tick) noexcept {
  NodeRobot::complete(tick);
  auto& scanner = port<hal::DistanceScanner>();
  scanner.samples = static_cast<std::uint32_t>(scanner.count / hal::DistanceScanner::kHeads);
  for (std::size_t head = 0; heads_ != nullptr && head < heads_->heads.size() && scanner.samples == 1; ++head) {
    const double angle = static_cast<double>(scanner.turn_rad) + heads_->heads[head].bearing_rad;
    scanner.angle_rad[head] = static_cast<float>(hal::wrapped(angle));
  }
  auto& gripper = port<hal::Gripper>();
  if (!tells_holding_) {
    // Claws that found nothing to hold are closed again by the robot itself, as it tries its grip.
    const double aperture = std::fabs(static_cast<double>(gripper.aperture_rad));
    gripper.holding = !gripper.busy && aperture >= hal::GripperDrive::kHolds_rad;
  }
}

}  // namespace tandem::bridges::footbot
