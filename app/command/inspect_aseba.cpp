// `tandem inspect` on links that carry ASEBA messages: a foot-bot's modules, whatever they are called.
#include <algorithm>
#include <cstdio>
#include <fmt/format.h>

#include "app/command/command.hpp"
#include "app/report.hpp"
#include "app/signals.hpp"
#include "bridges/aseba/message_link_text.hpp"
#include "bridges/aseba/network.hpp"
#include "bridges/aseba/reopening_messages.hpp"

namespace tandem::app {
namespace {

namespace aseba = bridges::aseba;

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
    if (node.ready() && node.statistics.reads == 0) (void)network.want(id, 0, node.image.size());
  }
}

/// It has described itself, or will not.
bool is_told(const aseba::Node& node) {
  return is_described(node) || (node.state == aseba::NodeState::Refused && node.statistics.impossible >= kEnough);
}

void print_node(const aseba::Node& node) {
  if (!is_described(node)) {
    fmt::print(
        "node {} did not describe itself: {} of its messages were heard, {} of its descriptions were broken off\n",
        node.id, node.statistics.messages, node.statistics.incomplete);
    if (!node.trouble.empty()) fmt::print("  {}\n", node.trouble);
    return;
  }
  fmt::print("node {} '{}', {}, protocol {}; {} messages, {} reads answered of {}, {:.1f} ms round trip at most\n",
             node.id, node.description.name, aseba::node_state_name(node.state), node.version, node.statistics.messages,
             node.statistics.answers, node.statistics.reads,
             static_cast<double>(node.statistics.max_round_trip_ns) * 1e-6);
  if (!node.trouble.empty()) fmt::print("  {}\n", node.trouble);
  if (!node.ready()) return;
  std::size_t width = 0;
  for (const aseba::Variable& v : node.description.variables) width = std::max(width, v.name.size());
  for (const aseba::Variable& v : node.description.variables) {
    fmt::print("  {:<{}} {:>5} at {:<5}", v.name, width, v.words, v.address);
    if (node.taken_ns(v.address, v.words) == 0) {
      fmt::print(" not read\n");
      continue;
    }
    for (std::size_t i = 0; i < std::min<std::size_t>(v.words, kShown); ++i)
      fmt::print(" {}", node.value(v.address + i));
    fmt::print("{}\n", v.words > kShown ? " …" : "");
  }
}

}  // namespace

int inspect_aseba(const InspectOptions& options) {
  const auto complain = [](int code, const std::string& message) {
    fmt::print(stderr, "error: {}\n", message);
    return code;
  };
  const auto opener = aseba::message_link_opener(options.link);
  if (!opener.ok()) return complain(kBadInput, opener.error().message);
  const std::atomic<bool>& stop = catch_signals();
  aseba::ReopeningMessages link(opener.value());
  aseba::Network network(link, {}, hal::Log([](hal::Severity severity, std::string_view text) {
                           if (severity != hal::Severity::Info) fmt::print(stderr, "{}\n", text);
                         }));
  const hal::TimeNs begin = bridges::monotonic_ns();
  const hal::TimeNs least = begin + static_cast<hal::TimeNs>(options.seconds * 1e9);
  std::size_t modules = 0;
  hal::TimeNs newest_ns = begin;
  for (hal::TimeNs now = begin; !stop.load(); now = bridges::monotonic_ns()) {
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
    return complain(kFailedRunning,
                    link.trouble().empty() ? "the link '" + options.link + "' did not open in time" : link.trouble());
  }
  bool any = false;
  for (const std::uint8_t id : heard(network)) {
    any = any || network.node(id).ready();
    print_node(network.node(id));
  }
  const auto messages = link.statistics();
  const auto& bus = network.statistics();
  print_table({{"link", fmt::format("{}: {} messages in, {} out, {} broken, {} dropped", link.name(), messages.received,
                                    messages.sent, messages.broken_in, messages.dropped)},
               {"bus", fmt::format("{} user events, {} messages of other hosts, {} not understood", bus.events,
                                   bus.other_hosts, bus.not_understood)}});
  return any ? kDone
             : complain(kFailedRunning, "no module describes itself on " + link.name() +
                                            "; is the robot switched on, and the bus set to 1 Mbit/s?");
}

}  // namespace tandem::app
