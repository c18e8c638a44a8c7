#include "mixed_reality/settings/epuck_parts.hpp"

#include "hal/spec/epuck.hpp"
#include "mixed_reality/settings/patience.hpp"

namespace tandem::mixed_reality {

hal::Result<EpuckParts> epuck_parts(const core::RobotItem& item, std::int64_t ticks_per_second,
                                    bridges::SendPermit permit) {
  const core::BridgeConfig& bridge = item.bridge.value();
  if (item.kind != hal::epuck::kDataSheet.kind)
    return hal::Error{"robot '" + item.id + "' is of the kind '" + item.kind + "', not an e-puck"};
  const auto address = bridges::parse_link(bridge.link);
  if (!address.ok()) return address.error();
  auto opener = bridges::epuck::epuck_link_opener(address.value(), {permit});
  if (!opener.ok()) return opener.error();
  EpuckParts parts;
  parts.opener = std::move(opener).value();
  parts.settings.link = bridge.link;
  parts.settings.firmware = bridge.firmware;
  parts.settings.driver.robot.id = item.id;
  parts.settings.driver.robot.tick_ns = hal::time_of_tick(1, ticks_per_second);
  parts.settings.driver.timing = bridges::epuck::timing_for(bridge.link);
  parts.settings.driver.ramp_ns = 0;  // the supervisor's ramp is the only one
  parts.settings.driver.command_timeout_ns = lost_after_ns(item, ticks_per_second);
  return parts;
}

}  // namespace tandem::mixed_reality
