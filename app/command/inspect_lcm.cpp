// `tandem inspect` on LCM: which eye-bots speak there, and what they say. Nothing is said to them.
#include <cstdio>
#include <fmt/format.h>
#include <memory>
#include <mutex>
#include <set>

#include "app/command/command.hpp"
#include "app/report.hpp"
#include "app/signals.hpp"
#include "bridges/eyebot/bridge.hpp"
#include "bridges/link/link_text.hpp"
#include "mixed_reality/time/monotonic.hpp"
#include "mixed_reality/time/pacer.hpp"

namespace tandem::app {
namespace {

namespace eyebot = bridges::eyebot;
using bridges::lcm_bus::LcmLink;
using bridges::lcm_bus::LcmMessage;

constexpr hal::TimeNs kListen_ns = hal::kNsPerSecond;  // five heartbeats of each robot

/// Names of robots whose heartbeat came.
struct Roll {
  std::mutex mutex;
  std::set<std::string> names;
};

void note_robot(Roll& roll, std::string_view channel) {
  constexpr std::string_view kHead = "eyebot/";
  channel.remove_prefix(kHead.size());
  const std::string_view name = channel.substr(0, channel.find('/'));
  if (!eyebot::is_robot_name(name)) return;
  const std::lock_guard lock(roll.mutex);
  roll.names.insert(std::string(name));
}

std::unique_ptr<eyebot::EyebotBridge> watch(const std::string& name, const std::shared_ptr<LcmLink>& link) {
  eyebot::BridgeSettings settings;
  settings.driver.robot.id = name;
  settings.driver.observe = true;
  auto bridge = std::make_unique<eyebot::EyebotBridge>(settings, [link] { return link; });
  for (const hal::PortType* type : eyebot::port_types()) {
    if (type->role == hal::Role::Sensor && type->name != "clock") (void)bridge->robot().require(*type);
  }
  bridge->start();
  return bridge;
}

void print_robot(eyebot::EyebotBridge& bridge) {
  const eyebot::BridgeStatus s = bridge.status();
  fmt::print("eye-bot '{}' on {}\n", s.name, s.link);
  std::string rates;
  for (std::size_t i = 0; i < eyebot::kTopics; ++i) {
    if (s.topics[i].received == 0) continue;
    rates += fmt::format("{}{} {}", rates.empty() ? "" : ", ", eyebot::topic_name(static_cast<eyebot::Topic>(i)),
                         s.topics[i].received);
  }
  print_table(
      {{"state", eyebot::state_name(s.state)},
       {"does", eyebot::mode_name(s.flight.mode)},
       {"fail-safe", eyebot::failsafe_name(s.flight.failsafe)},
       {"session", fmt::format("{:08x}", static_cast<std::uint32_t>(s.session))},
       {"messages", rates},
       {"link", fmt::format("{} lost on the way, {} old, {} damaged, {} from another start or robot", s.messages.lost,
                            s.messages.old, s.messages.refused + s.driver.not_understood, s.other_senders)}});
  if (!s.trouble.empty()) fmt::print("  {}\n", s.trouble);
  fmt::print("readings\n");
  for (const auto& port : bridge.robot().taken()) fmt::print("  {}\n", hal::to_text(*port.type, port.data));
}

}  // namespace

int inspect_lcm(const InspectOptions& options) {
  const auto complain = [](int code, const std::string& message) {
    fmt::print(stderr, "error: {}\n", message);
    return code;
  };
  const auto address = bridges::parse_link(options.link);
  if (!address.ok()) return complain(kBadInput, address.error().message);
  const auto link = LcmLink::open(address.value().target);
  if (!link.ok()) return complain(kFailedRunning, link.error().message);
  const auto roll = std::make_shared<Roll>();
  hal::Status ready =
      link.value()->subscribe("eyebot/[^/]+/heartbeat", [roll](const LcmMessage& m) { note_robot(*roll, m.channel); });
  if (ready.ok()) ready = link.value()->start();
  if (!ready.ok()) return complain(kFailedRunning, ready.error().message);

  const std::atomic<bool>& stop = catch_signals();
  mixed_reality::MonotonicTime clock;
  clock.sleep_until(clock.now_ns() + kListen_ns, stop);
  std::vector<std::unique_ptr<eyebot::EyebotBridge>> robots;
  {
    const std::lock_guard lock(roll->mutex);
    for (const std::string& name : roll->names) robots.push_back(watch(name, link.value()));
  }
  if (robots.empty()) return complain(kFailedRunning, "no eye-bot's heartbeat is heard on " + options.link);

  constexpr std::int64_t kTicksPerSecond = 10;
  mixed_reality::Pacer pacer(clock, kTicksPerSecond);
  for (const auto& robot : robots) robot->robot().set_origin(clock.now_ns());
  pacer.start();
  const auto ticks = static_cast<hal::Tick>(options.seconds * kTicksPerSecond);
  for (hal::Tick tick = 0; tick < ticks; ++tick) {
    for (const auto& robot : robots) robot->latch(tick, clock.now_ns());
    if (!pacer.wait_for_next(stop)) break;
  }
  for (const auto& robot : robots) print_robot(*robot);
  return kDone;
}

}  // namespace tandem::app
