// What an experiment says of a real e-puck, as its bridge needs it.
#pragma once
#include "bridges/epuck/bridge.hpp"
#include "core/scenario/scenario.hpp"
#include "hal/result.hpp"

namespace tandem::mixed_reality {

/// What a bridge to the robot of this item needs; shared by all commands. Errors: the item's kind is no e-puck, the
/// link is no serial one or has a baud rate that no e-puck has.
struct EpuckParts {
  bridges::epuck::BridgeSettings settings;
  bridges::LinkOpener opener;
};
hal::Result<EpuckParts> epuck_parts(const core::RobotItem& item, std::int64_t ticks_per_second,
                                    bridges::SendPermit permit = {});

}  // namespace tandem::mixed_reality
