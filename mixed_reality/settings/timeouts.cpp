#include "mixed_reality/settings/timeouts.hpp"

#include <algorithm>

namespace tandem::mixed_reality {

hal::TimeNs lost_after_ns(const core::RobotItem& item, std::int64_t ticks_per_second) noexcept {
  return std::max(static_cast<hal::TimeNs>(item.bridge->timeout_s * 1e9), hal::time_of_tick(2, ticks_per_second));
}

RearmParams rearm_params(const core::BridgeConfig& bridge) {
  RearmParams params;
  if (const auto policy = parse_rearm(bridge.rearm); policy.ok()) params.policy = policy.value();
  params.settle_s = bridge.settle_s;
  params.ramp_m_s2 = bridge.ramp_m_s2;
  return params;
}

}  // namespace tandem::mixed_reality
