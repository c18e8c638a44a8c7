// `tandem inspect` on links that carry ASEBA messages: a foot-bot's modules, whatever they are called.
#include <algorithm>

#include "bridges/aseba/message_link_text.hpp"
#include "bridges/aseba/network.hpp"
#include "bridges/aseba/reopening_messages.hpp"
#include "bridges/footbot/register.hpp"
#include "bridges/link/link_text.hpp"
#include "hal/robot/footbot.hpp"

namespace tandem::bridges::footbot {
namespace {

constexpr std::size_t kShown = 24;  // values of a variable
// A module says who it is in many messages, and behind a translator or a switch one module after the other does.
constexpr hal::TimeNs kLongest_ns = 20 * hal::kNsPerSecond;
constexpr hal::TimeNs kQuiet_ns = hal::kNsPerSecond;  // without a new module: three rounds of asking

/// Modules that were heard, by their number.
std::vector<std::uint8_t> heard(const aseba::Network& network) {
  std::vector<std::uint8_t> ids;
  for (const std::uint8_t id : network.known()) {
    if (network.node(id).state != aseba::NodeState::Absent) ids.push_back(id);
  }
  std::ranges::sort(ids);
  return ids;
}

constexpr std::uint64_t kEnough = 12;  // descriptions that cannot be true: another one will not be, either

bool is_described(const aseba::Node& node) {
  return node.ready() || (node.state == aseba::NodeState::Lost && !node.description.name.empty());
}

/// Has every variable of every node read that was not read yet.
void ask_all(aseba::Network& network) {
  for (const std::uint8_t id : network.known()) {
    const aseba::Node& node = network.node(id);
    if (node.ready() && node.statistics.reads == 0) (void)network.want(id, 0, node.description.named_words());
  }
}

/// It has described itself, or will not.
bool is_told(const aseba::Node& node) {
  return is_described(node) || (node.state == aseba::NodeState::Refused && node.statistics.impossible >= kEnough);
}

std::string values_of(const aseba::Node& node, const aseba::Variable& v) {
  if (node.taken_ns(v.address, v.words) == 0) return " not read";
  std::string text;
  for (std::size_t i = 0; i < std::min<std::size_t>(v.words, kShown); ++i)
    text += " " + std::to_string(node.value(v.address + i));
  return text + (v.words > kShown ? " …" : "");
}

void print_node(const InspectRequest& request, const aseba::Node& node) {
  const std::string who = "node " + std::to_string(node.id);
  if (!is_described(node)) {
    request.print(who + " did not describe itself: " + std::to_string(node.statistics.messages) +
                  " of its messages were heard, " + std::to_string(node.statistics.incomplete) +
                  " of its descriptions were broken off");
    if (!node.trouble.empty()) request.print("  " + node.trouble);
    return;
  }
  request.print(
      who + " '" + node.description.name + "', " + aseba::node_state_name(node.state) + ", protocol " +
      std::to_string(node.version) + "; " + std::to_string(node.statistics.messages) + " messages, " +
      std::to_string(node.statistics.answers) + " reads answered of " + std::to_string(node.statistics.reads) +
      formatted(", %.1f ms round trip at most", static_cast<double>(node.statistics.round_trips.largest_ns()) * 1e-6));
  if (!node.trouble.empty()) request.print("  " + node.trouble);
  if (!node.ready()) return;
  std::size_t width = 0;
  for (const aseba::Variable& v : node.description.variables) width = std::max(width, v.name.size());
  for (const aseba::Variable& v : node.description.variables) {
    request.print("  " + v.name + std::string(width - v.name.size(), ' ') +
                  formatted(" %5u at %-5u", static_cast<unsigned>(v.words), static_cast<unsigned>(v.address)) +
                  values_of(node, v));
  }
}

/// On a serial line an e-puck talks with 115200 baud, a foot-bot's CAN translator with 921600.
bool reads(const std::string& link) {
  const auto address = parse_link(link);
  const bool serial = address.ok() && address.value().scheme == LinkScheme::Serial;
  return aseba::message_link_opener(link).ok() && (!serial || address.value().rate == 921600);
}

hal::Status run(const InspectRequest& request) {
  const auto opener = aseba::message_link_opener(request.link);
  if (!opener.ok()) return opener.error();
  aseba::ReopeningMessages link(opener.value());
  aseba::Network network(link, {}, request.log);
  const hal::TimeNs begin = inspector_now_ns();
  const hal::TimeNs least = begin + static_cast<hal::TimeNs>(request.seconds * 1e9);
  std::size_t modules = 0;
  hal::TimeNs newest_ns = begin;
  for (hal::TimeNs now = begin; !request.stop.load(); now = inspector_now_ns()) {
    ask_all(network);
    network.poll(now);
    const std::vector<std::uint8_t> ids = heard(network);
    if (ids.size() != modules) newest_ns = now;
    modules = ids.size();
    const bool complete = !network.reading() && now - newest_ns >= kQuiet_ns &&
                          std::ranges::all_of(ids, [&](std::uint8_t id) { return is_told(network.node(id)); });
    if (now >= least && (complete || now - begin >= kLongest_ns)) break;
    link.wait(std::clamp<hal::TimeNs>(network.next_deadline() - now, 0, 20 * hal::kNsPerMs));
  }
  if (link.openings() == 0) {
    return hal::Error{link.trouble().empty() ? "the link '" + request.link + "' did not open in time" : link.trouble()};
  }
  bool any = false;
  for (const std::uint8_t id : heard(network)) {
    any = any || network.node(id).ready();
    print_node(request, network.node(id));
  }
  const auto messages = link.statistics();
  const auto& bus = network.statistics();
  request.print_table(
      {{"link", link.name() + ": " + std::to_string(messages.received) + " messages in, " +
                    std::to_string(messages.sent) + " out, " + std::to_string(messages.broken_in) + " broken, " +
                    std::to_string(messages.dropped) + " dropped"},
       {"bus", std::to_string(bus.events) + " user events, " + std::to_string(bus.other_hosts) +
                   " messages of other hosts, " + std::to_string(bus.not_understood) + " not understood"}});
  if (any) return {};
  return hal::Error{"no module describes itself on " + link.name() +
                    "; is the robot switched on, and the bus set to 1 Mbit/s?"};
}

}  // namespace

const InspectorType& inspector_type() noexcept {
  static const InspectorType type{
      hal::footbot::kName, "can:INTERFACE, slcan:DEVICE@RATE, serial:DEVICE@921600, tcp:HOST:PORT", &reads, &run};
  return type;
}

}  // namespace tandem::bridges::footbot
