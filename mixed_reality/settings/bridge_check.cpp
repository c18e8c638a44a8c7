#include "mixed_reality/settings/bridge_check.hpp"

#include <map>

#include "bridges/link/link_text.hpp"
#include "mixed_reality/safety/rearm.hpp"
#include "mixed_reality/settings/bridge_types.hpp"

namespace tandem::mixed_reality {
namespace {

/// Equal for two robots that would be one. Only on LCM do several share a link.
std::string reached_by(const core::RobotItem& item) {
  const core::BridgeConfig& bridge = *item.bridge;
  const std::string link = bridges::absolute_link(bridge.link);
  const auto address = bridges::parse_link(link);
  const bool shared = address.ok() && address.value().scheme == bridges::LinkScheme::Lcm;
  return shared ? link + " as '" + (bridge.name.empty() ? item.id : bridge.name) + "'" : link;
}

}  // namespace

void check_bridges(const core::Scenario& scenario, core::Problems& problems) {
  std::map<std::string, const core::RobotItem*> seen;
  for (const core::RobotItem& item : scenario.robots) {
    if (!item.bridge) continue;
    const auto complain = [&](const std::string& what) {
      problems.push_back({scenario.file, item.bridge->line, "robot '" + item.id + "': " + what});
    };
    if (const auto policy = parse_rearm(item.bridge->rearm); !policy.ok()) complain(policy.error().message);
    if (const hal::Status good = check_bridge(item, scenario.ticks_per_second); !good.ok())
      complain(good.error().message);
    const auto [first, fresh] = seen.emplace(reached_by(item), &item);
    if (!fresh) {
      complain("a second robot behind the link " + first->first + "; the first is '" + first->second->id +
               "' on line " + std::to_string(first->second->line));
    }
  }
}

}  // namespace tandem::mixed_reality
