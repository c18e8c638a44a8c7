#include "mixed_reality/settings/eyebot_parts.hpp"

#include "bridges/link/link_text.hpp"
#include "hal/spec/eyebot.hpp"
#include "mixed_reality/settings/patience.hpp"

namespace tandem::mixed_reality {

hal::Result<EyebotParts> eyebot_parts(const core::RobotItem& item, std::int64_t ticks_per_second,
                                      bridges::SendPermit permit) {
  const core::BridgeConfig& bridge = item.bridge.value();
  if (item.kind != hal::eyebot::kDataSheet.kind)
    return hal::Error{"robot '" + item.id + "' is of the kind '" + item.kind + "', not an eye-bot"};
  if (bridge.firmware != "auto")
    return hal::Error{"an eye-bot has no firmware '" + bridge.firmware + "'; leave firmware out"};
  const auto address = bridges::parse_link(bridge.link);
  if (!address.ok()) return address.error();
  if (address.value().scheme != bridges::LinkScheme::Lcm)
    return hal::Error{"link '" + bridge.link + "' does not carry an eye-bot's messages; write lcm:" +
                      std::string(bridges::lcm_bus::kDefaultLcmUrl)};
  EyebotParts parts;
  parts.settings.url = address.value().target;
  parts.settings.permit = permit;
  parts.opener = [url = parts.settings.url] { return bridges::lcm_bus::LcmLink::open(url); };
  bridges::eyebot::DriverSettings& driver = parts.settings.driver;
  driver.session = 0;  // to be drawn
  driver.name = bridge.name.empty() ? item.id : bridge.name;
  if (!bridges::eyebot::is_robot_name(driver.name))
    return hal::Error{"'" + driver.name +
                      "' cannot be part of a channel; an eye-bot's name has 1 to 24 letters, digits, '_' and '-'"};
  driver.robot.id = item.id;
  driver.robot.tick_ns = hal::time_of_tick(1, ticks_per_second);
  driver.command_timeout_ns = lost_after_ns(item, ticks_per_second);
  driver.world = {bridge.origin_m, bridge.turn_rad};
  parts.settings.farewell.land = bridge.land_at_end;
  return parts;
}

}  // namespace tandem::mixed_reality
