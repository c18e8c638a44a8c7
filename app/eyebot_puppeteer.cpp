#include "app/eyebot_puppeteer.hpp"

#include <algorithm>
#include <cmath>
#include <limits>

#include "hal/device/body_sensors.hpp"
#include "hal/device/cameras.hpp"
#include "hal/device/distance_scanner.hpp"
#include "hal/device/flight.hpp"
#include "hal/device/leds.hpp"
#include "hal/device/pan_tilt.hpp"
#include "hal/device/range_and_bearing.hpp"
#include "hal/device/ring_sensors.hpp"

namespace tandem::app {
namespace {

namespace emulator = bridges::eyebot_emulator;
using hal::FlightOrder;
using hal::FlightPhase;

constexpr const char* kAdvice =
    "give one the controller <eyebot_puppet library=\"puppet\" …> with flight_task, quadrotor_speed, flight_state and "
    "positioning";

template <class From, class To>
void copy(const From& from, To& to) {
  std::copy_n(from.begin(), std::min(from.size(), to.size()), to.begin());
}

/// The newest measurement of each head.
void read_scanner(const hal::DistanceScanner& scanner, emulator::BodySenses& senses) {
  senses.scanner_rad = static_cast<double>(scanner.turn_rad);
  for (std::size_t head = 0; head < senses.scan_m.size() && scanner.samples > 0; ++head) {
    const std::size_t last = scanner.samples - 1;
    if (scanner.too_near(head, last)) senses.scan_m[head] = 0.0;
    if (!scanner.too_near(head, last) && !scanner.sees_nothing(head, last)) {
      senses.scan_m[head] = static_cast<double>(scanner.distance(head, last));
    }
  }
}

void read_camera(const hal::PerspectiveCamera& camera, emulator::BodySenses& senses) {
  for (std::size_t i = 0; i < camera.count; ++i) {
    const hal::Rgb c = camera.color(i);
    senses.blobs.push_back({static_cast<double>(camera.x_px[i]), static_cast<double>(camera.y_px[i]), {c.r, c.g, c.b}});
  }
}

void read_flight(const hal::FlightState& state, emulator::BodySenses& senses) {
  senses.v_WB = state.velocity;
  senses.turn_rad_s = {0.0, 0.0, state.yaw_rad_s};
  senses.on_ground = state.phase == FlightPhase::Landed || state.phase == FlightPhase::Off;
  senses.at_ceiling = state.phase == FlightPhase::Attached;
}

std::vector<emulator::Heard> heard_by(const hal::RangeAndBearing& radio) {
  std::vector<emulator::Heard> all(radio.count);
  for (std::size_t i = 0; i < all.size(); ++i) {
    all[i].range_m = static_cast<double>(radio.range_m[i]);
    all[i].bearing_rad = static_cast<double>(radio.bearing_rad[i]);
    all[i].elevation_rad = static_cast<double>(radio.elevation_rad[i]);
    all[i].payload.assign(radio.message(i), radio.message(i) + radio.size[i]);
  }
  return all;
}

/// What the simulated robot is to be asked for: the manoeuvre, unless it is through with it.
FlightOrder order_of(emulator::Manoeuvre manoeuvre, FlightPhase phase) {
  const bool free = phase == FlightPhase::Hovering || phase == FlightPhase::Flying;
  switch (manoeuvre) {
    case emulator::Manoeuvre::TakeOff:
      return free ? FlightOrder::Fly : FlightOrder::TakeOff;
    case emulator::Manoeuvre::Detach:
      return free ? FlightOrder::Fly : FlightOrder::Detach;
    case emulator::Manoeuvre::Attach:
      return FlightOrder::Attach;
    case emulator::Manoeuvre::Rest:
    case emulator::Manoeuvre::Land:
      return phase == FlightPhase::Attached ? FlightOrder::Detach : FlightOrder::Land;
    case emulator::Manoeuvre::Fly:
      break;
  }
  return FlightOrder::Fly;
}

bool fits(const core::Space& space, core::RobotId robot) {
  return space.data_sheet(robot).kind == hal::eyebot::kDataSheet.kind &&
         space.port<hal::FlightTask>(robot) != nullptr && space.port<hal::QuadrotorSpeed>(robot) != nullptr &&
         space.port<hal::FlightState>(robot) != nullptr && space.port<hal::Positioning>(robot) != nullptr;
}

}  // namespace

hal::Result<core::RobotId> EyebotPuppeteer::find(const core::World& world, const std::string& id) {
  const core::Space& space = world.space();
  if (!id.empty()) {
    const core::RobotId robot = space.find_robot(id);
    if (!robot.valid()) return hal::Error{"the arena has no robot '" + id + "'"};
    if (!fits(space, robot)) {
      return hal::Error{"robot '" + id + "' is no eye-bot, or its controller does not take what it flies by; " +
                        kAdvice};
    }
    return robot;
  }
  for (std::size_t i = 0; i < space.robot_count(); ++i) {
    if (fits(space, space.robot(i))) return space.robot(i);
  }
  return hal::Error{std::string("the arena has no eye-bot that can be flown from outside; ") + kAdvice};
}

void EyebotPuppeteer::after_sense(core::World& world) {
  const core::Space& space = world.space();
  if (!space.contains(robot_)) return;  // a hook took it away: its firmware goes on without a body
  emulator::BodySenses senses;
  std::vector<emulator::Heard> heard;
  const auto with = [&]<class Port>(auto read) {
    if (const auto* port = space.port<Port>(robot_)) read(*port);
  };
  with.operator()<hal::Positioning>([&](const auto& p) {
    senses.p_WB = p.p_WB;
    senses.q_WB = p.q_WB;
    senses.ground_m = std::max(0.0, p.p_WB[2]);
  });
  with.operator()<hal::FlightState>([&](const auto& p) { read_flight(p, senses); });
  with.operator()<hal::Altimeter>([&](const auto& p) {
    senses.ground_m = static_cast<double>(p.ground_m);
    senses.ceiling_m = static_cast<double>(p.ceiling_m);
  });
  with.operator()<hal::Proximity>([&](const auto& p) { copy(p.distance_m, senses.distance_m); });
  with.operator()<hal::Light>([&](const auto& p) { copy(p.level, senses.light); });
  with.operator()<hal::DistanceScanner>([&](const auto& p) { read_scanner(p, senses); });
  with.operator()<hal::PanTiltEncoder>([&](const auto& p) {
    senses.pan_rad = p.pan_rad;
    senses.tilt_rad = p.tilt_rad;
  });
  with.operator()<hal::PerspectiveCamera>([&](const auto& p) { read_camera(p, senses); });
  with.operator()<hal::Battery>([&](const auto& p) { senses.charge = static_cast<double>(p.charge); });
  with.operator()<hal::RangeAndBearing>([&](const auto& p) { heard = heard_by(p); });
  body_.set_senses(senses, heard);
}

void EyebotPuppeteer::after_filter(core::World& world) {
  core::Space& space = world.space();
  if (!space.contains(robot_)) return;
  const emulator::BodyCommand command = body_.command();
  const auto with = [&]<class Port>(auto write) {
    if (auto* port = space.port<Port>(robot_)) write(*port);
  };
  const FlightPhase phase = space.port<hal::FlightState>(robot_)->phase;
  with.operator()<hal::FlightTask>([&](auto& p) {
    p.order = order_of(command.manoeuvre, phase);
    p.speed_m_s = command.manoeuvre_m_s;
  });
  with.operator()<hal::QuadrotorSpeed>([&](auto& p) {
    p.velocity = command.motors ? command.velocity_m_s : std::array<double, 3>{};
    p.yaw_rad_s = command.motors ? command.yaw_rad_s : 0.0;
  });
  with.operator()<hal::RingLeds>([&](auto& p) {
    p.rgb = {};
    if (command.lights.lower_on) copy(command.lights.lower, p.rgb);
  });
  with.operator()<hal::UpperRingLeds>([&](auto& p) {
    p.rgb = {};
    if (command.lights.upper_on) copy(command.lights.upper, p.rgb);
  });
  with.operator()<hal::CameraLed>([&](auto& p) {
    p.rgb = {};
    if (command.lights.beacon_on) p.rgb = command.lights.beacon;
  });
  with.operator()<hal::PanTiltDrive>([&](auto& p) {
    p.pan_rad = command.pan_rad;
    p.tilt_rad = command.tilt_rad;
    p.laser = command.laser;
  });
  with.operator()<hal::ScannerDrive>([&](auto& p) {
    p.mode = static_cast<hal::ScannerMode>(command.scanner);
    p.speed_rad_s = command.scanner_rad_s;
    p.angle_rad = command.scanner_rad;
  });
  with.operator()<hal::RangeAndBearingSend>([&](auto& p) {
    p.sending = !command.radio.empty();
    p.size = static_cast<std::uint8_t>(std::min<std::size_t>(command.radio.size(), p.payload.size()));
    p.payload = {};
    copy(command.radio, p.payload);
  });
}

}  // namespace tandem::app
