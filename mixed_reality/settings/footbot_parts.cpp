#include "mixed_reality/settings/footbot_parts.hpp"

#include "hal/spec/footbot.hpp"
#include "mixed_reality/settings/map_file.hpp"
#include "mixed_reality/settings/patience.hpp"

namespace tandem::mixed_reality {

hal::Result<FootbotParts> footbot_parts(const core::RobotItem& item, std::int64_t ticks_per_second,
                                        bridges::SendPermit permit) {
  const core::BridgeConfig& bridge = item.bridge.value();
  if (item.kind != hal::footbot::kDataSheet.kind)
    return hal::Error{"robot '" + item.id + "' is of the kind '" + item.kind + "', not a foot-bot"};
  if (bridge.firmware != "auto")
    return hal::Error{"a foot-bot's modules have no firmware '" + bridge.firmware + "'; leave firmware out"};
  auto opener = bridges::aseba::message_link_opener(bridge.link, {permit});
  if (!opener.ok()) return opener.error();
  if (bridge.map.empty()) {
    return hal::Error{"the <bridge> of the foot-bot '" + item.id +
                      "' names no map of its variables; write map=\"footbot_map.xml\""};
  }
  core::Problems problems;
  auto map = read_footbot_map(bridge.map, problems);
  if (!map) {
    std::string message = "the map of the foot-bot '" + item.id + "' cannot be used";
    for (const core::Problem& p : problems) message += "\n" + core::to_text(p);
    return hal::Error{message};
  }
  FootbotParts parts;
  parts.opener = std::move(opener).value();
  parts.settings.link = bridge.link;
  parts.settings.driver.map = std::move(*map);
  parts.settings.driver.robot.id = item.id;
  parts.settings.driver.robot.tick_ns = hal::time_of_tick(1, ticks_per_second);
  parts.settings.driver.command_timeout_ns = lost_after_ns(item, ticks_per_second);
  return parts;
}

}  // namespace tandem::mixed_reality
