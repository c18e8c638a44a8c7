// Makes bridges from experiment files; both `tandem run` and `tandem robot` go this way.
#pragma once
#include <cstdint>
#include <vector>

#include "bridges/bridge_type.hpp"
#include "core/scenario/scenario.hpp"
#include "hal/catalog.hpp"

namespace tandem::mixed_reality {

/// Request for the bridge of one robot of the scenario; `item.bridge` is set. The caller adds the permit and the
/// clock.
bridges::BridgeRequest bridge_request(const core::Scenario& scenario, const core::RobotItem& item, std::uint64_t seed);

/// Makes the bridge that the robot's kind needs, or only looks for what would keep it from being made. Errors: no
/// bridge for that kind; those of BridgeType::make.
bridges::MadeBridge make_bridge(const hal::Catalog& catalog, const bridges::BridgeRequest& request,
                                const hal::Log& log);
hal::Status check_bridge(const hal::Catalog& catalog, const bridges::BridgeRequest& request);

/// The files that the bridge reads.
std::vector<bridges::InputFile> bridge_inputs(const hal::Catalog& catalog, const bridges::BridgeRequest& request);

}  // namespace tandem::mixed_reality
