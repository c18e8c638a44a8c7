#include "bridges/eyebot_emulator/body.hpp"

#include <algorithm>

#include "hal/device/body_sensors.hpp"
#include "hal/device/cameras.hpp"
#include "hal/device/distance_scanner.hpp"
#include "hal/device/flight.hpp"
#include "hal/device/leds.hpp"
#include "hal/device/pan_tilt.hpp"
#include "hal/device/range_and_bearing.hpp"
#include "hal/device/ring_sensors.hpp"

namespace tandem::bridges::eyebot_emulator {
namespace {

using hal::FlightOrder;
using hal::FlightPhase;

/// The newest measurement of each head.
void read_scanner(const hal::DistanceScanner& scanner, BodySenses& senses) {
  senses.scanner_rad = static_cast<double>(scanner.turn_rad);
  for (std::size_t head = 0; head < senses.scan_m.size() && scanner.samples > 0; ++head) {
    const std::size_t last = scanner.samples - 1;
    if (scanner.too_near(head, last)) senses.scan_m[head] = 0.0;
    if (!scanner.too_near(head, last) && !scanner.sees_nothing(head, last)) {
      senses.scan_m[head] = static_cast<double>(scanner.distance(head, last));
    }
  }
}

void read_camera(const hal::PerspectiveCamera& camera, BodySenses& senses) {
  for (std::size_t i = 0; i < camera.count; ++i) {
    const hal::Rgb c = camera.color(i);
    senses.blobs.push_back({static_cast<double>(camera.x_px[i]), static_cast<double>(camera.y_px[i]), {c.r, c.g, c.b}});
  }
}

void read_flight(const hal::FlightState& state, BodySenses& senses) {
  senses.v_WB = state.velocity;
  senses.turn_rad_s = {0.0, 0.0, state.yaw_rad_s};
  senses.on_ground = state.phase == FlightPhase::Landed || state.phase == FlightPhase::Off;
  senses.at_ceiling = state.phase == FlightPhase::Attached;
}

/// What the other robot is to be asked for: the manoeuvre, unless it is through with it.
FlightOrder order_of(Manoeuvre manoeuvre, FlightPhase phase) {
  const bool free = phase == FlightPhase::Hovering || phase == FlightPhase::Flying;
  switch (manoeuvre) {
    case Manoeuvre::TakeOff:
      return free ? FlightOrder::Fly : FlightOrder::TakeOff;
    case Manoeuvre::Detach:
      return free ? FlightOrder::Fly : FlightOrder::Detach;
    case Manoeuvre::Attach:
      return FlightOrder::Attach;
    case Manoeuvre::Rest:
    case Manoeuvre::Land:
      return phase == FlightPhase::Attached ? FlightOrder::Detach : FlightOrder::Land;
    case Manoeuvre::Fly:
      break;
  }
  return FlightOrder::Fly;
}

}  // namespace

std::vector<const hal::PortType*> body_ports() {
  return port_types_of<hal::Positioning, hal::FlightState, hal::Altimeter, hal::Proximity, hal::Light,
                       hal::DistanceScanner, hal::PanTiltEncoder, hal::PerspectiveCamera, hal::Battery,
                       hal::RangeAndBearing, hal::FlightTask, hal::QuadrotorSpeed, hal::RingLeds, hal::UpperRingLeds,
                       hal::CameraLed, hal::PanTiltDrive, hal::ScannerDrive, hal::RangeAndBearingSend>();
}

void read_body(const PortBank& bank, BodySenses& senses) {
  bank.read<hal::Positioning>([&](const auto& p) {
    senses.p_WB = p.p_WB;
    senses.q_WB = p.q_WB;
    senses.ground_m = std::max(0.0, p.p_WB[2]);
  });
  bank.read<hal::FlightState>([&](const auto& p) { read_flight(p, senses); });
  bank.read<hal::Altimeter>([&](const auto& p) {
    senses.ground_m = static_cast<double>(p.ground_m);
    senses.ceiling_m = static_cast<double>(p.ceiling_m);
  });
  bank.read<hal::Proximity>([&](const auto& p) { copy_values(p.distance_m, senses.distance_m); });
  bank.read<hal::Light>([&](const auto& p) { copy_values(p.level, senses.light); });
  bank.read<hal::DistanceScanner>([&](const auto& p) { read_scanner(p, senses); });
  bank.read<hal::PanTiltEncoder>([&](const auto& p) {
    senses.pan_rad = p.pan_rad;
    senses.tilt_rad = p.tilt_rad;
  });
  bank.read<hal::PerspectiveCamera>([&](const auto& p) { read_camera(p, senses); });
  bank.read<hal::Battery>([&](const auto& p) { senses.charge = static_cast<double>(p.charge); });
}

void write_body(PortBank& bank, const BodyCommand& command) {
  auto& task = bank.port<hal::FlightTask>();
  task.order = order_of(command.manoeuvre, bank.port<hal::FlightState>().phase);
  task.speed_m_s = command.manoeuvre_m_s;
  auto& speed = bank.port<hal::QuadrotorSpeed>();
  speed.velocity = command.motors ? command.velocity_m_s : std::array<double, 3>{};
  speed.yaw_rad_s = command.motors ? command.yaw_rad_s : 0.0;
  const Lights& lights = command.lights;
  auto& lower = bank.port<hal::RingLeds>();
  lower.rgb = {};
  if (lights.lower_on) copy_values(lights.lower, lower.rgb);
  auto& upper = bank.port<hal::UpperRingLeds>();
  upper.rgb = {};
  if (lights.upper_on) copy_values(lights.upper, upper.rgb);
  bank.port<hal::CameraLed>().rgb = lights.beacon_on ? lights.beacon : std::array<std::uint8_t, 3>{};
  auto& head = bank.port<hal::PanTiltDrive>();
  head.pan_rad = command.pan_rad;
  head.tilt_rad = command.tilt_rad;
  head.laser = command.laser;
  write_scanner(bank, command);
  auto& radio = bank.port<hal::RangeAndBearingSend>();
  radio.sending = !command.radio.empty();
  radio.size = static_cast<std::uint8_t>(std::min<std::size_t>(command.radio.size(), radio.payload.size()));
  radio.payload = {};
  copy_values(command.radio, radio.payload);
}

}  // namespace tandem::bridges::eyebot_emulator
