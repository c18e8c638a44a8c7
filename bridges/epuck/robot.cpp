#include "bridges/epuck/robot.hpp"

#include <algorithm>

#include "bridges/epuck/conversions.hpp"
#include "hal/spec/epuck.hpp"

namespace tandem::bridges::epuck {
namespace {

namespace spec = hal::epuck;

constexpr hal::TimeNs kLeastFresh = 150 * hal::kNsPerMs;

template <std::size_t N, std::size_t M, class F>
void convert(const std::array<std::uint16_t, N>& raw, std::uint32_t& count, std::array<float, M>& values,
             F&& f) noexcept {
  static_assert(N <= M);
  count = N;
  for (std::size_t i = 0; i < N; ++i) values[i] = static_cast<float>(f(raw[i]));
}

}  // namespace

EpuckRobot::EpuckRobot(RobotSettings settings) : settings_(std::move(settings)) {
  if (settings_.fresh_ns <= 0) settings_.fresh_ns = std::max(2 * settings_.tick_ns, kLeastFresh);
  devices_ = {
      {&hal::port_type<hal::Proximity>(), &proximity_, {Quantity::Proximity}},
      {&hal::port_type<hal::Light>(), &light_, {Quantity::Ambient}},
      {&hal::port_type<hal::Ground>(), &ground_, {Quantity::Ground}},
      {&hal::port_type<hal::Accelerometer>(), &accelerometer_, {Quantity::Acceleration}},
      {&hal::port_type<hal::Microphones>(), &microphones_, {Quantity::Microphones}},
      {&hal::port_type<hal::Battery>(), &battery_, {Quantity::Battery}},
      {&hal::port_type<hal::WheelEncoders>(), &encoders_, {Quantity::Encoders}},
      {&hal::port_type<hal::Clock>(), &clock_, {}},
      {&hal::port_type<hal::RangeAndBearing>(), &rab_, {}, false},
      {&hal::port_type<hal::WheelSpeeds>(), &wheels_, {}},
      {&hal::port_type<hal::RingLeds>(), &ring_, {}},
      {&hal::port_type<hal::BodyLed>(), &body_, {}},
      {&hal::port_type<hal::FrontLed>(), &front_, {}},
      {&hal::port_type<hal::RangeAndBearingSend>(), &rab_send_, {}, false},
  };
}

const hal::DataSheet& EpuckRobot::data_sheet() const noexcept {
  return spec::kDataSheet;
}

bool EpuckRobot::listed(const hal::PortType& type) const {
  const auto& list = type.role == hal::Role::Sensor ? settings_.sensors : settings_.actuators;
  return !list || std::find(list->begin(), list->end(), type.name) != list->end();
}

void* EpuckRobot::take(const hal::PortType& type) {
  const std::string what =
      std::string(type.role == hal::Role::Sensor ? "sensor '" : "actuator '") + std::string(type.name) + "'";
  const auto device = std::find_if(devices_.begin(), devices_.end(), [&](const Device& d) {
    return d.type->role == type.role && d.type->name == type.name;
  });
  if (device == devices_.end()) throw hal::DeviceError("e-puck '" + settings_.id + "' has no " + what);
  if (device->type->layout != type.layout) {
    throw hal::DeviceError("e-puck '" + settings_.id + "': the controller was built for another form of " + what +
                           "; rebuild it");
  }
  if (!listed(type)) {
    throw hal::DeviceError("e-puck '" + settings_.id + "': the configuration does not list " + what + "; add it there");
  }
  return take(*device);
}

void* EpuckRobot::take(const Device& device) {
  const auto same = [&](const PortView& view) { return view.data == device.data; };
  if (std::none_of(taken_.begin(), taken_.end(), same)) taken_.push_back({device.type, device.data});
  demand_.add(device.needs);
  return device.data;
}

void* EpuckRobot::find(const hal::PortType& type) noexcept {
  const auto device = std::find_if(devices_.begin(), devices_.end(), [&](const Device& d) {
    return d.over_serial && d.type->role == type.role && d.type->name == type.name && d.type->layout == type.layout;
  });
  return device != devices_.end() ? take(*device) : nullptr;
}

void EpuckRobot::stamp(hal::Reading& reading, Quantity quantity, const Samples& samples,
                       hal::TimeNs now) const noexcept {
  if (!samples.known.has(quantity)) return;  // stays absent: never received, or not to be had from this firmware
  // A stamp in the future is not believed.
  const hal::TimeNs taken = std::min(samples.taken_ns[static_cast<std::size_t>(quantity)], now);
  reading.taken_ns = taken - settings_.origin_ns;
  reading.validity = now - taken <= settings_.fresh_ns ? hal::Validity::Fresh : hal::Validity::Stale;
}

void EpuckRobot::fill(const Samples& samples, const Identity& identity, hal::Tick tick, hal::TimeNs now) noexcept {
  const RawSensors& raw = samples.raw;
  stamp(proximity_, Quantity::Proximity, samples, now);
  stamp(light_, Quantity::Ambient, samples, now);
  stamp(ground_, Quantity::Ground, samples, now);
  stamp(accelerometer_, Quantity::Acceleration, samples, now);
  stamp(microphones_, Quantity::Microphones, samples, now);
  stamp(battery_, Quantity::Battery, samples, now);
  stamp(encoders_, Quantity::Encoders, samples, now);

  proximity_.range_m = static_cast<float>(spec::kProximityRange_m);
  if (samples.known.has(Quantity::Proximity)) {
    convert(raw.proximity, proximity_.count, proximity_.distance_m, proximity_distance_m);
  }
  if (samples.known.has(Quantity::Ambient)) convert(raw.ambient, light_.count, light_.level, light_level);
  if (samples.known.has(Quantity::Ground)) {
    // The board counts from the left, the data sheet from the right.
    convert(std::array{raw.ground[2], raw.ground[1], raw.ground[0]}, ground_.count, ground_.reflectance,
            ground_reflectance);
  }
  if (samples.known.has(Quantity::Microphones))
    convert(raw.microphones, microphones_.count, microphones_.level, sound_level);
  if (samples.accelerometer.verdict() != AccelerometerCheck::Verdict::Believed) {
    accelerometer_.validity = hal::Validity::Absent;
  } else if (samples.known.has(Quantity::Acceleration)) {
    const auto force = force_m_s2(raw.acceleration, samples.accelerometer.zero());
    std::transform(force.begin(), force.end(), accelerometer_.force_m_s2.begin(),
                   [](double v) { return static_cast<float>(v); });
  }
  if (samples.known.has(Quantity::Battery)) {
    const BatteryState state = battery_state(raw.battery, identity.firmware);
    battery_.supply_V = static_cast<float>(state.supply_V);
    battery_.charge = static_cast<float>(state.charge);
  }
  encoders_.left_m = steps_to_m(samples.left_steps);
  encoders_.right_m = steps_to_m(samples.right_steps);
  encoders_.left_m_s = static_cast<float>(samples.left_steps_per_s * spec::kMetresPerStep);
  encoders_.right_m_s = static_cast<float>(samples.right_steps_per_s * spec::kMetresPerStep);

  clock_.tick = tick;
  clock_.now_ns = tick * settings_.tick_ns;
  clock_.tick_s = hal::to_seconds(settings_.tick_ns);
  clock_.taken_ns = clock_.now_ns;
  clock_.validity = hal::Validity::Fresh;
  rab_ = hal::RangeAndBearing{};  // messages are of one tick; whoever relays them does so after this
}

Actuation EpuckRobot::lamps() const noexcept {
  Actuation a;
  for (std::size_t i = 0; i < a.ring.size(); ++i) a.ring[i] = ring_.color(i);
  a.body = body_.on;
  a.front = front_.on;
  return a;
}

void EpuckRobot::make_safe() noexcept {
  for (const Device& d : devices_) {
    if (d.type->role == hal::Role::Actuator) d.type->reset(d.data);
  }
}

}  // namespace tandem::bridges::epuck
