#include "bridges/eyebot/robot.hpp"

#include <algorithm>

#include "hal/check.hpp"
#include "hal/device/body_sensors.hpp"
#include "hal/device/cameras.hpp"
#include "hal/device/distance_scanner.hpp"
#include "hal/device/flight.hpp"
#include "hal/device/leds.hpp"
#include "hal/device/pan_tilt.hpp"
#include "hal/device/range_and_bearing.hpp"
#include "hal/device/ring_sensors.hpp"

namespace tandem::bridges::eyebot {
namespace {

constexpr hal::TimeNs kLeastFresh = 150 * hal::kNsPerMs;

template <class... T>
std::vector<const hal::PortType*> types() {
  return {&hal::port_type<T>()...};
}

}  // namespace

const std::vector<const hal::PortType*>& port_types() {
  static const auto all =
      types<hal::Positioning, hal::FlightState, hal::Altimeter, hal::Gyroscope, hal::Proximity, hal::Light,
            hal::DistanceScanner, hal::PerspectiveCamera, hal::PanTiltEncoder, hal::RangeAndBearing, hal::Battery,
            hal::Clock, hal::QuadrotorPosition, hal::QuadrotorSpeed, hal::FlightTask, hal::RingLeds, hal::UpperRingLeds,
            hal::CameraLed, hal::PanTiltDrive, hal::ScannerDrive, hal::RangeAndBearingSend>();
  return all;
}

EyebotRobot::EyebotRobot(RobotSettings settings) : settings_(std::move(settings)) {
  settings_.tick_ns = std::max<hal::TimeNs>(settings_.tick_ns, 1);
  if (settings_.fresh_ns <= 0) settings_.fresh_ns = std::max(2 * settings_.tick_ns, kLeastFresh);
  for (const hal::PortType* type : port_types()) {
    const std::size_t blocks = (type->size + sizeof(std::max_align_t) - 1) / sizeof(std::max_align_t);
    rows_.push_back({type, std::make_unique<std::max_align_t[]>(blocks)});
    type->reset(rows_.back().data.get());
  }
}

const EyebotRobot::Row& EyebotRobot::row(const hal::PortType& type) const noexcept {
  const auto found = std::ranges::find(rows_, &type, &Row::type);
  TANDEM_CHECK(found != rows_.end(), "asked for one of port_types()");
  return *found;
}

bool EyebotRobot::listed(const hal::PortType& type) const {
  const auto& list = type.role == hal::Role::Sensor ? settings_.sensors : settings_.actuators;
  return !list || std::ranges::find(*list, type.name) != list->end();
}

void* EyebotRobot::take(const hal::PortType& type) {
  const std::string who = "eye-bot '" + settings_.id + "'";
  const std::string what =
      std::string(type.role == hal::Role::Sensor ? "sensor '" : "actuator '") + std::string(type.name) + "'";
  const auto found =
      std::ranges::find_if(rows_, [&](const Row& r) { return r.type->role == type.role && r.type->name == type.name; });
  if (found == rows_.end()) throw hal::DeviceError(who + " has no " + what + " that can be reached over LCM");
  if (found->type->layout != type.layout) {
    throw hal::DeviceError(who + ": the controller was built for another form of " + what + "; rebuild it");
  }
  if (!listed(type)) throw hal::DeviceError(who + ": the configuration does not list " + what + "; add it there");
  return take(*found);
}

void* EyebotRobot::take(Row& row) {
  if (!row.taken) order_.push_back(static_cast<std::size_t>(&row - rows_.data()));
  row.taken = true;
  return row.data.get();
}

void* EyebotRobot::find(const hal::PortType& type) noexcept {
  const auto found = std::ranges::find_if(rows_, [&](const Row& r) {
    return r.type->role == type.role && r.type->name == type.name && r.type->layout == type.layout;
  });
  return found != rows_.end() ? take(*found) : nullptr;
}

std::vector<EyebotRobot::PortView> EyebotRobot::taken() const {
  std::vector<PortView> all;
  for (const std::size_t i : order_) all.push_back({rows_[i].type, rows_[i].data.get()});
  return all;
}

void EyebotRobot::stamp(hal::Reading& reading, hal::TimeNs taken, hal::TimeNs period_ns,
                        hal::TimeNs now) const noexcept {
  reading.taken_ns = taken - settings_.origin_ns;
  const hal::TimeNs limit = settings_.fresh_ns + period_ns;
  reading.validity = now - taken <= limit ? hal::Validity::Fresh : hal::Validity::Stale;
}

void EyebotRobot::tell_time(hal::Tick tick) noexcept {
  auto& clock = port<hal::Clock>();
  clock.tick = tick;
  clock.now_ns = tick * settings_.tick_ns;
  clock.tick_s = hal::to_seconds(settings_.tick_ns);
  clock.taken_ns = clock.now_ns;
  clock.validity = hal::Validity::Fresh;
}

}  // namespace tandem::bridges::eyebot
