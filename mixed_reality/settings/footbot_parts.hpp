// What an experiment says of a real foot-bot, as its bridge needs it.
#pragma once
#include "bridges/aseba/message_link_text.hpp"
#include "bridges/footbot/bridge.hpp"
#include "core/scenario/scenario.hpp"
#include "hal/result.hpp"

namespace tandem::mixed_reality {

/// What a bridge to the robot of this item needs; shared by all commands. Errors: the item's kind is no foot-bot, the
/// link carries no ASEBA messages, there is no map, or the map has errors: they are all in the message, one a line.
struct FootbotParts {
  bridges::footbot::BridgeSettings settings;
  bridges::aseba::MessageLinkOpener opener;
};
hal::Result<FootbotParts> footbot_parts(const core::RobotItem& item, std::int64_t ticks_per_second,
                                        bridges::SendPermit permit = {});

}  // namespace tandem::mixed_reality
