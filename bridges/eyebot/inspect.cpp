// `tandem inspect` on LCM: which eye-bots speak there, and what they say. Nothing is said to them.
#include <memory>
#include <mutex>
#include <set>

#include "bridges/eyebot/bridge.hpp"
#include "bridges/eyebot/register.hpp"
#include "bridges/link/link_text.hpp"
#include "hal/robot/eyebot.hpp"

namespace tandem::bridges::eyebot {
namespace {

using lcm_bus::LcmLink;
using lcm_bus::LcmMessage;

constexpr hal::TimeNs kListen_ns = hal::kNsPerSecond;  // five heartbeats of each robot

/// Names of robots whose heartbeat came.
struct Roll {
  std::mutex mutex;
  std::set<std::string> names;
};

void note_robot(Roll& roll, std::string_view channel) {
  const std::string_view name = robot_of(channel);
  if (name.empty()) return;
  const std::lock_guard lock(roll.mutex);
  roll.names.insert(std::string(name));
}

std::unique_ptr<EyebotBridge> watch(const std::string& name, const std::shared_ptr<LcmLink>& link) {
  BridgeSettings settings;
  settings.driver.robot.id = name;
  settings.driver.observe = true;
  auto bridge = std::make_unique<EyebotBridge>(settings, [link] { return link; });
  for (const hal::PortType* type : port_types()) {
    if (type->role == hal::Role::Sensor && type->name != "clock") (void)bridge->robot().require(*type);
  }
  bridge->start();
  return bridge;
}

void print_robot(const InspectRequest& request, const EyebotBridge& bridge) {
  const BridgeStatus s = bridge.status();
  request.print("eye-bot '" + s.name + "' on " + s.link);
  std::string rates;
  for (std::size_t i = 0; i < kTopics; ++i) {
    if (s.topics[i].received == 0) continue;
    rates += (rates.empty() ? "" : ", ") + std::string(topic_name(static_cast<Topic>(i))) + " " +
             std::to_string(s.topics[i].received);
  }
  request.print_table(
      {{"state", state_name(s.state)},
       {"does", mode_name(s.flight.mode)},
       {"fail-safe", failsafe_name(s.flight.failsafe)},
       {"session", formatted("%08x", static_cast<unsigned>(s.session))},
       {"messages", rates},
       {"link", std::to_string(s.messages.lost) + " lost on the way, " + std::to_string(s.messages.old) + " old, " +
                    std::to_string(s.messages.refused + s.driver.not_understood) + " damaged, " +
                    std::to_string(s.other_senders) + " from another start or robot"}});
  if (!s.trouble.empty()) request.print("  " + s.trouble);
  print_readings(request, bridge.taken());
}

bool reads(const std::string& link) {
  const auto address = parse_link(link);
  return address.ok() && address.value().scheme == LinkScheme::Lcm;
}

hal::Status run(const InspectRequest& request) {
  const auto address = parse_link(request.link);
  if (!address.ok()) return address.error();
  const auto link = LcmLink::open(address.value().target);
  if (!link.ok()) return link.error();
  const auto roll = std::make_shared<Roll>();
  hal::Status ready =
      link.value()->subscribe("eyebot/[^/]+/heartbeat", [roll](const LcmMessage& m) { note_robot(*roll, m.channel); });
  if (ready.ok()) ready = link.value()->start();
  if (!ready.ok()) return ready;

  (void)wait_until(inspector_now_ns() + kListen_ns, request.stop);
  std::vector<std::unique_ptr<EyebotBridge>> robots;
  {
    const std::lock_guard lock(roll->mutex);
    for (const std::string& name : roll->names) robots.push_back(watch(name, link.value()));
  }
  if (robots.empty()) return hal::Error{"no eye-bot's heartbeat is heard on " + request.link};
  latch_for(request, robots, [](EyebotBridge&) {});
  for (const auto& robot : robots) print_robot(request, *robot);
  return {};
}

}  // namespace

const InspectorType& inspector_type() noexcept {
  static const InspectorType type{hal::eyebot::kName, "lcm:URL", &reads, &run};
  return type;
}

}  // namespace tandem::bridges::eyebot
