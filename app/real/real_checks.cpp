#include "app/real/register.hpp"
#include "mixed_reality/settings/bridge_check.hpp"
#include "mixed_reality/settings/bridge_request.hpp"
#include "mixed_reality/settings/peer_check.hpp"
#include "mixed_reality/settings/tracker_check.hpp"

namespace tandem::app {

void check_real(const core::Scenario& scenario, const hal::Catalog& catalog, core::Problems& problems) {
  mixed_reality::check_peers(scenario, problems);
  mixed_reality::check_bridges(scenario, catalog, problems);
  mixed_reality::check_trackers(scenario, catalog, problems);
}

std::vector<std::string> outlooks_of_trackers(const core::Scenario& scenario, const hal::Catalog& catalog) {
  return mixed_reality::outlooks(scenario, catalog);
}

std::vector<RealSideType::Input> inputs_of_bridges(const core::Scenario& scenario, const hal::Catalog& catalog) {
  std::vector<RealSideType::Input> inputs;
  for (const core::RobotItem& robot : scenario.robots) {
    if (!robot.bridge) continue;
    for (const auto& [what, path] :
         mixed_reality::bridge_inputs(catalog, mixed_reality::bridge_request(scenario, robot, 0)))
      inputs.push_back({robot.id, what, path});
  }
  return inputs;
}

}  // namespace tandem::app
