// What an experiment says of a real eye-bot, as its bridge needs it.
#pragma once
#include "bridges/eyebot/bridge.hpp"
#include "core/scenario/scenario.hpp"
#include "hal/result.hpp"

namespace tandem::mixed_reality {

/// What a bridge to the robot of this item needs; shared by all commands. Errors: the item's kind is no eye-bot, the
/// link is no LCM, the name cannot be part of a channel.
struct EyebotParts {
  bridges::eyebot::BridgeSettings settings;
  bridges::eyebot::LcmOpener opener;
};
hal::Result<EyebotParts> eyebot_parts(const core::RobotItem& item, std::int64_t ticks_per_second,
                                      bridges::SendPermit permit = {});

}  // namespace tandem::mixed_reality
