// `tandem inspect`: who is there, and what it reads. Moves nothing.
#include <cstdio>
#include <fmt/format.h>

#include "app/command/command.hpp"
#include "app/report.hpp"
#include "app/signals.hpp"
#include "bridges/aseba/message_link_text.hpp"
#include "bridges/epuck/bridge.hpp"
#include "bridges/link/link_text.hpp"
#include "mixed_reality/time/pacer.hpp"

namespace tandem::app {
namespace {

namespace epuck = bridges::epuck;

/// Everything that an e-puck senses.
std::vector<epuck::EpuckRobot::PortView> take_all(epuck::EpuckRobot& robot) {
  const hal::PortType* const sensors[] = {&hal::port_type<hal::Proximity>(),    &hal::port_type<hal::Light>(),
                                          &hal::port_type<hal::Ground>(),       &hal::port_type<hal::Accelerometer>(),
                                          &hal::port_type<hal::Microphones>(),  &hal::port_type<hal::Battery>(),
                                          &hal::port_type<hal::WheelEncoders>()};
  for (const hal::PortType* type : sensors) (void)robot.require(*type);
  return robot.taken();
}

}  // namespace

int inspect(const InspectOptions& options) {
  const auto complain = [](int code, const std::string& message) {
    fmt::print(stderr, "error: {}\n", message);
    return code;
  };
  // On a serial line an e-puck talks with 115200 baud, a foot-bot's CAN translator with 921600.
  const auto address = bridges::parse_link(options.link);
  const bool serial = address.ok() && address.value().scheme == bridges::LinkScheme::Serial;
  if (bridges::aseba::message_link_opener(options.link).ok() && (!serial || address.value().rate == 921600)) {
    return inspect_aseba(options);
  }
  if (!address.ok()) return complain(kBadInput, address.error().message);
  if (address.value().scheme == bridges::LinkScheme::Lcm) return inspect_lcm(options);
  auto opener = bridges::epuck::epuck_link_opener(address.value());
  if (!opener.ok()) return complain(kBadInput, opener.error().message);

  epuck::BridgeSettings settings;
  settings.driver.timing = epuck::timing_for(options.link);
  const hal::Log log([](hal::Severity severity, std::string_view text) {
    if (severity != hal::Severity::Info) fmt::print(stderr, "{}\n", text);
  });
  epuck::EpuckBridge bridge(settings, std::move(opener).value(), log);
  const auto ports = take_all(bridge.robot());
  const std::atomic<bool>& stop = catch_signals();
  bridge.start();
  hal::Status ready;
  for (hal::TimeNs waited = 0; waited < 10 * hal::kNsPerSecond && !stop.load(); waited += 200 * hal::kNsPerMs) {
    ready = bridge.wait_active(200 * hal::kNsPerMs);
    if (ready.ok() ||
        (waited >= hal::kNsPerSecond && bridge.status().links_opened == 0 && !bridge.status().trouble.empty()))
      break;
  }
  if (!ready.ok()) return complain(kFailedRunning, ready.error().message);

  constexpr std::int64_t kTicksPerSecond = 10;
  mixed_reality::MonotonicTime clock;
  mixed_reality::Pacer pacer(clock, kTicksPerSecond);
  bridge.robot().set_origin(clock.now_ns());
  pacer.start();
  const auto ticks = static_cast<hal::Tick>(options.seconds * kTicksPerSecond);
  for (hal::Tick tick = 0; tick < ticks; ++tick) {
    bridge.latch(tick, clock.now_ns());
    bridge.commit(clock.now_ns());  // the commands are untouched: wheels 0, lamps off
    if (!pacer.wait_for_next(stop)) break;
  }
  bridge.latch(ticks, clock.now_ns());
  const epuck::BridgeStatus status = bridge.status();
  fmt::print("e-puck on {}\n", status.link);
  print_table(
      {{"firmware", std::string(status.identity.version_text())},
       {"hardware", status.identity.hardware != 0 ? fmt::format("{:X}", status.identity.hardware) : "not told"},
       {"state", epuck::state_name(status.state)},
       {"round trip", fmt::format("{:.1f} ms on average, {:.1f} ms at most",
                                  status.session.answers > 0 ? static_cast<double>(status.session.sum_round_trip_ns) *
                                                                   1e-6 / static_cast<double>(status.session.answers)
                                                             : 0.0,
                                  static_cast<double>(status.session.max_round_trip_ns) * 1e-6)},
       {"link", fmt::format("{} bytes in, {} out; {} answers to {} packets, {} silences, {} cut short",
                            status.bytes.bytes_in, status.bytes.bytes_out, status.session.answers,
                            status.session.packets, status.session.silent, status.session.cut_short)}});
  fmt::print("readings\n");
  for (const auto& port : ports) fmt::print("  {}\n", hal::to_text(*port.type, port.data));
  bridge.shut_down();
  return status.state == epuck::SessionState::Active
             ? kDone
             : complain(kFailedRunning, "the robot does not answer any more: " + status.trouble);
}

}  // namespace tandem::app
