#include "mixed_reality/settings/peer_check.hpp"

#include <map>

#include "bridges/link/link_text.hpp"

namespace tandem::mixed_reality {

bool is_emulated(const core::PeerConfig& peer) noexcept {
  return std::string_view(peer.link).substr(0, peer.link.find(':')) == kEmulatedPeer;
}

void check_peers(const core::Scenario& scenario, core::Problems& problems) {
  std::map<std::string, const core::RobotItem*> seen;
  for (const core::RobotItem& item : scenario.robots) {
    if (!item.peer || item.peer->link.empty() || is_emulated(*item.peer)) continue;
    const auto complain = [&](const std::string& what) {
      problems.push_back({scenario.file, item.peer->line, "robot '" + item.id + "': " + what});
    };
    const auto address = bridges::parse_link(item.peer->link);
    if (!address.ok()) {
      complain(address.error().message);
      continue;
    }
    if (const auto opener = bridges::byte_link_opener(address.value()); !opener.ok()) complain(opener.error().message);
    const auto [first, fresh] = seen.emplace(bridges::absolute_link(item.peer->link), &item);
    if (!fresh)
      complain("a second peer behind the link " + first->first + "; the first is '" + first->second->id + "' on line " +
               std::to_string(first->second->line));
  }
}

}  // namespace tandem::mixed_reality
