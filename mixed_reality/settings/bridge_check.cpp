#include "mixed_reality/settings/bridge_check.hpp"

#include <map>

#include "bridges/link/link_text.hpp"
#include "mixed_reality/safety/rearm.hpp"
#include "mixed_reality/settings/bridge_request.hpp"

namespace tandem::mixed_reality {
namespace {

/// Equal for two robots that would be one.
std::string reached_by(const hal::Catalog& catalog, const bridges::BridgeRequest& request) {
  const auto* const type = catalog.find<bridges::BridgeType>(request.kind);
  const bool shares = type != nullptr && type->reached_by != nullptr;
  return shares ? type->reached_by(request) : bridges::absolute_link(request.link);
}

}  // namespace

void check_bridges(const core::Scenario& scenario, const hal::Catalog& catalog, core::Problems& problems) {
  std::map<std::string, const core::RobotItem*> seen;
  for (const core::RobotItem& item : scenario.robots) {
    if (!item.bridge) continue;
    const auto complain = [&](const std::string& what) {
      problems.push_back({scenario.file, item.bridge->line, "robot '" + item.id + "': " + what});
    };
    if (const auto policy = parse_rearm(item.bridge->rearm); !policy.ok()) complain(policy.error().message);
    const bridges::BridgeRequest request = bridge_request(scenario, item, scenario.seed.value_or(1));
    if (const hal::Status good = check_bridge(catalog, request); !good.ok()) complain(good.error().message);
    const auto [first, fresh] = seen.emplace(reached_by(catalog, request), &item);
    if (!fresh) {
      complain("a second robot behind the link " + first->first + "; the first is '" + first->second->id +
               "' on line " + std::to_string(first->second->line));
    }
  }
}

}  // namespace tandem::mixed_reality
