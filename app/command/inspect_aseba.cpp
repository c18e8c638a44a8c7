// `tandem inspect` on links that carry ASEBA messages: a foot-bot's modules, whatever they are called.
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

/// Has every variable of every node read that was not read yet.
void ask_all(aseba::Network& network) {
  for (const std::uint8_t id : network.known()) {
    const aseba::Node& node = network.node(id);
    if (node.ready() && node.statistics.reads == 0) (void)network.want(id, 0, node.image.size());
  }
}

void print_node(const aseba::Node& node) {
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
  const hal::TimeNs end = bridges::monotonic_ns() + static_cast<hal::TimeNs>(options.seconds * 1e9);
  for (hal::TimeNs now = bridges::monotonic_ns(); now < end && !stop.load(); now = bridges::monotonic_ns()) {
    ask_all(network);
    network.poll(now);
    link.wait(std::clamp<hal::TimeNs>(network.next_deadline() - now, 0, 20 * hal::kNsPerMs));
  }
  if (link.openings() == 0) {
    return complain(kFailedRunning,
                    link.trouble().empty() ? "the link '" + options.link + "' did not open in time" : link.trouble());
  }
  bool any = false;
  for (const std::uint8_t id : network.known()) {
    any = any || network.node(id).ready();
    print_node(network.node(id));
  }
  const auto messages = link.statistics();
  const auto& heard = network.statistics();
  print_table({{"link", fmt::format("{}: {} messages in, {} out, {} broken, {} dropped", link.name(), messages.received,
                                    messages.sent, messages.broken_in, messages.dropped)},
               {"bus", fmt::format("{} user events, {} messages of other hosts, {} not understood", heard.events,
                                   heard.other_hosts, heard.not_understood)}});
  return any ? kDone
             : complain(kFailedRunning, "no module describes itself on " + link.name() +
                                            "; is the robot switched on, and the bus set to 1 Mbit/s?");
}

}  // namespace tandem::app
