// `tandem inspect` on a serial line: an e-puck, and everything that it senses.
#include <array>

#include "bridges/epuck/bridge.hpp"
#include "bridges/epuck/register.hpp"
#include "hal/device/body_sensors.hpp"
#include "hal/device/ring_sensors.hpp"
#include "hal/device/wheels.hpp"
#include "hal/robot/epuck.hpp"
#include "hal/robot/epuck2.hpp"

namespace tandem::bridges::epuck {
namespace {

/// Everything that an e-puck senses.
void take_all(EpuckRobot& robot) {
  for (const hal::PortType* type :
       port_types_of<hal::Proximity, hal::Light, hal::Ground, hal::Accelerometer, hal::Microphones, hal::Battery,
                     hal::WheelEncoders, hal::Gyroscope, hal::TimeOfFlight, hal::Cliff, hal::Selector>())
    (void)robot.require(*type);
}

constexpr hal::TimeNs kFirst_ns = 10 * hal::kNsPerSecond, kAgain_ns = 3 * hal::kNsPerSecond;

/// Error: nobody answers in time.
hal::Status wait_for(EpuckBridge& bridge, hal::TimeNs most_ns, const std::atomic<bool>& stop) {
  hal::Status ready;
  for (hal::TimeNs waited = 0; waited < most_ns && !stop.load(); waited += 200 * hal::kNsPerMs) {
    ready = bridge.wait_active(200 * hal::kNsPerMs);
    if (ready.ok()) return ready;
    if (waited >= hal::kNsPerSecond && bridge.status().links_opened == 0 && !bridge.status().trouble.empty())
      return ready;
  }
  return ready;
}

void print_status(const InspectRequest& request, const BridgeStatus& s) {
  const RoundTrips& trips = s.session.round_trips;
  request.print("e-puck on " + s.link);
  request.print_table(
      {{"firmware", std::string(s.identity.version_text())},
       {"hardware",
        s.identity.hardware != 0 ? formatted("%X", static_cast<unsigned>(s.identity.hardware)) : "not told"},
       {"state", state_name(s.state)},
       {"round trip", formatted("%.1f ms on average, %.1f ms at most", static_cast<double>(trips.mean_ns()) * 1e-6,
                                static_cast<double>(trips.largest_ns()) * 1e-6)},
       {"link", std::to_string(s.bytes.bytes_in) + " bytes in, " + std::to_string(s.bytes.bytes_out) + " out; " +
                    std::to_string(s.session.answers) + " answers to " + std::to_string(s.session.packets) +
                    " packets, " + std::to_string(s.session.silent) + " silences, " +
                    std::to_string(s.session.cut_short) + " cut short"}});
}

bool reads(const std::string& link) {
  // Of those in a network only what nobody else speaks; other robots are reached by tcp: as well.
  return !link.starts_with("tcp:") && epuck_link(link).ok();
}

hal::Status run(const InspectRequest& request) {
  auto link = epuck_link(request.link);
  if (!link.ok()) return link.error();
  BridgeSettings settings;
  settings.driver.timing = timing_for(request.link);
  settings.driver.wire = link.value().wire;
  settings.driver.robot.kind = &hal::epuck2::kind();  // which has all that any has; what is not told stays absent
  EpuckBridge bridge(settings, std::move(link).value().open, request.log);
  take_all(bridge.robot());
  bridge.start();
  if (hal::Status ready = wait_for(bridge, kFirst_ns, request.stop); !ready.ok()) return ready;
  // The commands are untouched: wheels 0, lamps off.
  latch_for(request, std::array{&bridge}, [](EpuckBridge& b) { b.commit(inspector_now_ns()); });
  // Bytes that nobody asked for, or a moment without answers, say nothing of whether it is there.
  if (bridge.status().state != SessionState::Active) (void)wait_for(bridge, kAgain_ns, request.stop);
  const BridgeStatus status = bridge.status();
  print_status(request, status);
  print_readings(request, bridge.taken());
  bridge.shut_down();
  if (status.state == SessionState::Active) return {};
  return hal::Error{"the robot does not answer any more: " + status.trouble};
}

}  // namespace

const InspectorType& inspector_type() noexcept {
  static const InspectorType type{hal::epuck::kName, kLinks, &reads, &run};
  return type;
}

}  // namespace tandem::bridges::epuck
