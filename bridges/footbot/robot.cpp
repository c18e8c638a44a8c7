#include "bridges/footbot/robot.hpp"

#include <algorithm>
#include <cmath>

#include "hal/angle.hpp"
#include "hal/check.hpp"
#include "hal/device/body_sensors.hpp"
#include "hal/device/distance_scanner.hpp"
#include "hal/device/gripper.hpp"
#include "hal/device/leds.hpp"
#include "hal/device/range_and_bearing.hpp"
#include "hal/device/ring_sensors.hpp"
#include "hal/device/turret.hpp"
#include "hal/device/wheels.hpp"
#include "hal/elementary.hpp"

namespace tandem::bridges::footbot {
namespace {

namespace spec = hal::footbot;

constexpr hal::TimeNs kLeastFresh = 150 * hal::kNsPerMs;

template <class... T>
std::vector<const hal::PortType*> types() {
  return {&hal::port_type<T>()...};
}

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
      types<hal::WheelEncoders, hal::Odometry, hal::Proximity, hal::Light, hal::BaseGround, hal::MotorGround,
            hal::DistanceScanner, hal::TurretEncoder, hal::Gripper, hal::RangeAndBearing, hal::Battery,
            hal::Accelerometer, hal::Gyroscope, hal::Clock, hal::WheelSpeeds, hal::RingLeds, hal::ScannerDrive,
            hal::TurretDrive, hal::GripperDrive, hal::RangeAndBearingSend>();
  return all;
}

FootbotRobot::FootbotRobot(RobotSettings settings, const FootbotMap& map) : settings_(std::move(settings)) {
  if (settings_.fresh_ns <= 0) settings_.fresh_ns = std::max(2 * settings_.tick_ns, kLeastFresh);
  for (const hal::PortType* type : port_types()) {
    const std::size_t blocks = (type->size + sizeof(std::max_align_t) - 1) / sizeof(std::max_align_t);
    rows_.push_back({type, std::make_unique<std::max_align_t[]>(blocks)});
    type->reset(rows_.back().data.get());
    rows_.back().present = feeds(map, *type);
  }
  const bool counts = row(hal::port_type<hal::WheelEncoders>()).present;
  for (Row& r : rows_) {
    r.present = r.present || r.type == &hal::port_type<hal::Clock>();
    r.present = r.present || (counts && r.type == &hal::port_type<hal::Odometry>());
  }
  tells_holding_ = feeds(map, hal::port_type<hal::Gripper>(), "holding");
  port<hal::Proximity>().range_m = static_cast<float>(spec::kProximityRange_m);
  auto& scanner = port<hal::DistanceScanner>();
  scanner.short_min_m = static_cast<float>(spec::kShortMin_m);
  scanner.short_max_m = static_cast<float>(spec::kShortMax_m);
  scanner.long_min_m = static_cast<float>(spec::kLongMin_m);
  scanner.long_max_m = static_cast<float>(spec::kLongMax_m);
  // Heads that no variable of the map tells of see nothing, not something at 0 m.
  for (std::size_t head = 0; head < hal::DistanceScanner::kHeads; ++head) {
    scanner.distance_m[head] = hal::DistanceScanner::is_short(head) ? scanner.short_max_m : scanner.long_max_m;
  }
}

const FootbotRobot::Row& FootbotRobot::row(const hal::PortType& type) const noexcept {
  const auto found = std::ranges::find(rows_, &type, &Row::type);
  TANDEM_CHECK(found != rows_.end(), "asked for one of port_types()");
  return *found;
}

bool FootbotRobot::listed(const hal::PortType& type) const {
  const auto& list = type.role == hal::Role::Sensor ? settings_.sensors : settings_.actuators;
  return !list || std::ranges::find(*list, type.name) != list->end();
}

void* FootbotRobot::take(const hal::PortType& type) {
  const std::string who = "foot-bot '" + settings_.id + "'";
  const std::string what =
      std::string(type.role == hal::Role::Sensor ? "sensor '" : "actuator '") + std::string(type.name) + "'";
  const auto found =
      std::ranges::find_if(rows_, [&](const Row& r) { return r.type->role == type.role && r.type->name == type.name; });
  if (found == rows_.end()) throw hal::DeviceError(who + " has no " + what);
  if (!found->present) {
    throw hal::DeviceError(who + " has no " + what + " in its map: no variable there is for it; add it to the map");
  }
  if (found->type->layout != type.layout) {
    throw hal::DeviceError(who + ": the controller was built for another form of " + what + "; rebuild it");
  }
  if (!listed(type)) throw hal::DeviceError(who + ": the configuration does not list " + what + "; add it there");
  return take(*found);
}

void* FootbotRobot::take(Row& row) {
  if (!row.taken) order_.push_back(static_cast<std::size_t>(&row - rows_.data()));
  row.taken = true;
  return row.data.get();
}

void* FootbotRobot::find(const hal::PortType& type) noexcept {
  const auto found = std::ranges::find_if(rows_, [&](const Row& r) {
    return r.present && r.type->role == type.role && r.type->name == type.name && r.type->layout == type.layout;
  });
  return found != rows_.end() ? take(*found) : nullptr;
}

std::vector<FootbotRobot::PortView> FootbotRobot::taken() const {
  std::vector<PortView> all;
  for (const std::size_t i : order_) all.push_back({rows_[i].type, rows_[i].data.get()});
  return all;
}

std::vector<const hal::PortType*> FootbotRobot::present() const {
  std::vector<const hal::PortType*> all;
  for (const Row& r : rows_) {
    if (r.present) all.push_back(r.type);
  }
  return all;
}

bool FootbotRobot::uses(const hal::PortType& type) const noexcept {
  const auto taken = [this](const hal::PortType& wanted) {
    const auto found = std::ranges::find(rows_, &wanted, &Row::type);
    return found != rows_.end() && found->taken;
  };
  if (&type == &hal::port_type<hal::WheelEncoders>() && taken(hal::port_type<hal::Odometry>())) return true;
  return taken(type);
}

void FootbotRobot::stamp(hal::Reading& reading, hal::TimeNs taken, hal::TimeNs period_ns,
                         hal::TimeNs now) const noexcept {
  if (taken == 0) return;  // stays absent
  reading.taken_ns = taken - settings_.origin_ns;
  const hal::TimeNs limit = settings_.fresh_ns + period_ns;
  reading.validity = now - taken <= limit ? hal::Validity::Fresh : hal::Validity::Stale;
}

void FootbotRobot::reckon() noexcept {
  const auto& wheels = port<hal::WheelEncoders>();
  auto& place = port<hal::Odometry>();
  static_cast<hal::Reading&>(place) = wheels;
  if (wheels.validity == hal::Validity::Absent) return;
  const double left = wheels.left_m - left_m_;
  const double right = wheels.right_m - right_m_;
  left_m_ = wheels.left_m;
  right_m_ = wheels.right_m;
  if (!reckoning_) {
    reckoning_ = true;
    return;
  }
  // Along the arc's chord, whose direction is the mean of the headings before and after.
  const double turn = (right - left) / spec::kWheelBase_m;
  const double half = 0.5 * turn;
  const double chord = 0.5 * (left + right) * (std::fabs(half) < 1e-9 ? 1.0 : hal::sin(half) / half);
  place.x_m += chord * hal::cos(place.heading_rad + half);
  place.y_m += chord * hal::sin(place.heading_rad + half);
  place.heading_rad = hal::wrapped(place.heading_rad + turn);
}

void FootbotRobot::complete(hal::Tick tick) noexcept {
  auto& clock = port<hal::Clock>();
  clock.tick = tick;
  clock.now_ns = tick * settings_.tick_ns;
  clock.tick_s = hal::to_seconds(settings_.tick_ns);
  clock.taken_ns = clock.now_ns;
  clock.validity = hal::Validity::Fresh;
  reckon();
  auto& scanner = port<hal::DistanceScanner>();
  scanner.samples = static_cast<std::uint32_t>(scanner.count / hal::DistanceScanner::kHeads);
  for (std::size_t head = 0; head < spec::kScanner.size() && scanner.samples == 1; ++head) {
    const double angle = static_cast<double>(scanner.turn_rad) + spec::kScanner[head].bearing_rad;
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
