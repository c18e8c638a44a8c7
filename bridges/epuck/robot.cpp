#include "bridges/epuck/robot.hpp"

#include <algorithm>

#include "bridges/epuck/conversions.hpp"
#include "hal/device/body_sensors.hpp"
#include "hal/device/leds.hpp"
#include "hal/device/range_and_bearing.hpp"
#include "hal/device/ring_sensors.hpp"
#include "hal/device/wheels.hpp"
#include "hal/robot/epuck.hpp"

namespace tandem::bridges::epuck {
namespace {

const std::vector<const hal::PortType*>& port_types() {
  static const auto all = port_types_of<hal::Proximity, hal::Light, hal::Ground, hal::Accelerometer, hal::Microphones,
                                        hal::Battery, hal::WheelEncoders, hal::Gyroscope, hal::TimeOfFlight, hal::Cliff,
                                        hal::Selector, hal::Clock, hal::RangeAndBearing, hal::WheelSpeeds,
                                        hal::RingLeds, hal::BodyLed, hal::FrontLed, hal::RangeAndBearingSend>();
  return all;
}

template <std::size_t N, std::size_t M, class F>
void convert(const std::array<std::uint16_t, N>& raw, std::uint32_t& count, std::array<float, M>& values,
             F&& f) noexcept {
  static_assert(N <= M);
  count = N;
  for (std::size_t i = 0; i < N; ++i) values[i] = static_cast<float>(f(raw[i]));
}

std::uint32_t microphones_of(const hal::RobotKind& kind) noexcept {
  const auto* part = kind.part<hal::MicrophonesPart>();
  return part != nullptr ? static_cast<std::uint32_t>(std::min<std::size_t>(part->mounts.size(), 4)) : 0;
}

double range_of(const hal::RobotKind& kind) noexcept {
  const auto* part = kind.part<hal::TimeOfFlightPart>();
  return part != nullptr ? part->range_m : 0.0;
}

}  // namespace

EpuckRobot::EpuckRobot(RobotSettings settings)
    : BridgedRobot("e-puck", hal::epuck::kind(), std::move(settings), port_types()),
      conversions_(kind()),
      microphones_(microphones_of(kind())),
      time_of_flight_range_m_(range_of(kind())) {
  constexpr std::string_view kOnlyEpuck2 = "; an <e-puck2> has one";
  if (kind().part<hal::GyroscopePart>() == nullptr) leave_out(hal::port_type<hal::Gyroscope>(), kOnlyEpuck2);
  if (kind().part<hal::TimeOfFlightPart>() == nullptr) leave_out(hal::port_type<hal::TimeOfFlight>(), kOnlyEpuck2);
  if (kind().part<hal::CliffPart>() == nullptr) leave_out(hal::port_type<hal::Cliff>(), kOnlyEpuck2);
  if (kind().part<hal::SelectorPart>() == nullptr) leave_out(hal::port_type<hal::Selector>(), kOnlyEpuck2);
  leave_out(hal::port_type<hal::RangeAndBearing>());
  leave_out(hal::port_type<hal::RangeAndBearingSend>());
}

QuantitySet EpuckRobot::demand() const noexcept {
  QuantitySet all{Quantity::Encoders};
  const auto ask = [&]<class Port>(Quantity quantity) {
    if (uses<Port>()) all.add(quantity);
  };
  ask.operator()<hal::Proximity>(Quantity::Proximity);
  ask.operator()<hal::Light>(Quantity::Ambient);
  ask.operator()<hal::Ground>(Quantity::Ground);
  ask.operator()<hal::Accelerometer>(Quantity::Acceleration);
  ask.operator()<hal::Microphones>(Quantity::Microphones);
  ask.operator()<hal::Battery>(Quantity::Battery);
  ask.operator()<hal::Gyroscope>(Quantity::Gyro);
  ask.operator()<hal::TimeOfFlight>(Quantity::TimeOfFlight);
  ask.operator()<hal::Cliff>(Quantity::Ground);
  ask.operator()<hal::Selector>(Quantity::Selector);
  return all;
}

std::string EpuckRobot::untold(const AnswerLayout& layout, const Samples& samples) const {
  std::string names;
  const auto add = [&]<class Port>(bool told) {
    if (uses<Port>() && !told) names += (names.empty() ? "" : ", ") + std::string(Port::kName);
  };
  add.operator()<hal::Ground>(layout.ground_bytes > 0 && !samples.ground.missing());
  add.operator()<hal::Battery>(layout.battery_bytes > 0);
  add.operator()<hal::Gyroscope>(layout.gyro_bytes > 0 && !samples.gyro.missing());
  add.operator()<hal::TimeOfFlight>(layout.time_of_flight_bytes > 0);
  add.operator()<hal::Cliff>(layout.ground_bytes > 6 && !samples.ground.missing());
  add.operator()<hal::Selector>(layout.selector_bytes > 0);
  return names;
}

void EpuckRobot::fill(const Samples& samples, const Identity& identity, hal::Tick tick, hal::TimeNs now) noexcept {
  const RawSensors& raw = samples.raw;
  const auto stamped = [&]<class Port>(Quantity quantity) -> Port& {
    auto& reading = port<Port>();
    // Never received, or not to be had from this firmware: it stays absent. A stamp in the future is not believed.
    const hal::TimeNs taken = samples.taken_ns[static_cast<std::size_t>(quantity)];
    if (samples.known.has(quantity)) stamp(reading, std::min(taken, now), 0, now);
    return reading;
  };
  auto& proximity = stamped.operator()<hal::Proximity>(Quantity::Proximity);
  auto& light = stamped.operator()<hal::Light>(Quantity::Ambient);
  auto& ground = stamped.operator()<hal::Ground>(Quantity::Ground);
  auto& accelerometer = stamped.operator()<hal::Accelerometer>(Quantity::Acceleration);
  auto& microphones = stamped.operator()<hal::Microphones>(Quantity::Microphones);
  auto& battery = stamped.operator()<hal::Battery>(Quantity::Battery);
  auto& encoders = stamped.operator()<hal::WheelEncoders>(Quantity::Encoders);
  auto& gyroscope = stamped.operator()<hal::Gyroscope>(Quantity::Gyro);
  stamped.operator()<hal::Selector>(Quantity::Selector);

  proximity.range_m = static_cast<float>(conversions_.proximity_range_m());
  if (samples.known.has(Quantity::Proximity)) {
    convert(raw.proximity, proximity.count, proximity.distance_m,
            [this](std::uint16_t counts) { return conversions_.proximity_distance_m(counts); });
  }
  if (samples.known.has(Quantity::Ambient)) convert(raw.ambient, light.count, light.level, light_level);
  if (samples.known.has(Quantity::Ground)) {
    // The board counts from the left, the kind from the right.
    convert(std::array{raw.ground[2], raw.ground[1], raw.ground[0]}, ground.count, ground.reflectance,
            ground_reflectance);
  }
  if (samples.known.has(Quantity::Microphones)) {
    convert(raw.microphones, microphones.count, microphones.level, sound_level);
    microphones.count = std::min(microphones_, identity.is_epuck2() ? 4U : 3U);
  }
  if (samples.known.has(Quantity::Gyro)) {
    const auto turn = turn_rad_s(raw.gyro);
    std::transform(turn.begin(), turn.end(), port<hal::Gyroscope>().rate_rad_s.begin(),
                   [](double v) { return static_cast<float>(v); });
  }
  // Zeros alone are no measurement: without a floor board black ground would be seen, without a gyroscope no turning.
  if (!samples.ground.measured) ground.validity = hal::Validity::Absent;
  if (!samples.gyro.measured) gyroscope.validity = hal::Validity::Absent;
  fill_time_of_flight(raw, stamped.operator()<hal::TimeOfFlight>(Quantity::TimeOfFlight));
  fill_cliff(raw, stamped.operator()<hal::Cliff>(Quantity::Ground));
  if (!samples.ground.measured) port<hal::Cliff>().validity = hal::Validity::Absent;
  port<hal::Selector>().position = raw.selector;
  if (samples.accelerometer.verdict() != AccelerometerCheck::Verdict::Believed) {
    accelerometer.validity = hal::Validity::Absent;
  } else if (samples.known.has(Quantity::Acceleration)) {
    const auto force = force_m_s2(raw.acceleration, samples.accelerometer.zero());
    std::transform(force.begin(), force.end(), accelerometer.force_m_s2.begin(),
                   [](double v) { return static_cast<float>(v); });
  }
  if (samples.known.has(Quantity::Battery)) {
    const BatteryState state = conversions_.battery_state(raw.battery, identity.firmware);
    battery.supply_V = static_cast<float>(state.supply_V);
    battery.charge = static_cast<float>(state.charge);
  }
  encoders.left_m = conversions_.steps_to_m(samples.left_steps);
  encoders.right_m = conversions_.steps_to_m(samples.right_steps);
  encoders.left_m_s = static_cast<float>(conversions_.to_m_s(samples.left_steps_per_s));
  encoders.right_m_s = static_cast<float>(conversions_.to_m_s(samples.right_steps_per_s));

  tell_time(tick);
  port<hal::RangeAndBearing>() = {};  // messages are of one tick; whoever relays them does so after this
}

/// 0 is told before the sensor has measured for the first time.
void EpuckRobot::fill_time_of_flight(const RawSensors& raw, hal::TimeOfFlight& port) const noexcept {
  if (raw.time_of_flight_mm == 0) port.validity = hal::Validity::Absent;
  port.range_m = static_cast<float>(time_of_flight_range_m_);
  port.distance_m = static_cast<float>(time_of_flight_m(raw.time_of_flight_mm, time_of_flight_range_m_));
}

void EpuckRobot::fill_cliff(const RawSensors& raw, hal::Cliff& port) const noexcept {
  port.count = raw.cliffs;
  for (std::size_t i = 0; i < raw.cliff.size(); ++i)
    port.reflectance[i] = static_cast<float>(ground_reflectance(raw.cliff[i]));
  if (raw.cliffs == 0) port.validity = hal::Validity::Absent;
}

Actuation EpuckRobot::lamps() const noexcept {
  Actuation a;
  const auto& ring = port<hal::RingLeds>();
  for (std::size_t i = 0; i < a.ring.size(); ++i) a.ring[i] = ring.color(i);
  a.body = port<hal::BodyLed>().on;
  a.front = port<hal::FrontLed>().on;
  return a;
}

}  // namespace tandem::bridges::epuck
