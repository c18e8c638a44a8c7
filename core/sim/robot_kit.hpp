// Common data of the robots of a block.
#pragma once
#include <optional>

#include "core/sim/settings.hpp"

namespace tandem::core {

inline bool same_battery(const BatteryConfig& a, const BatteryConfig& b) {
  return a.model == b.model && a.start_charge == b.start_charge && a.full_charge == b.full_charge &&
         a.delta == b.delta && a.pos_delta == b.pos_delta && a.orient_delta == b.orient_delta;
}

inline bool same_kit(const RobotItem& a, const RobotItem& b) {
  return a.kind == b.kind && a.own_kind == b.own_kind && a.controller == b.controller &&
         same_battery(a.battery, b.battery);
}

/// Robots that share a block must share everything that is not per robot.
inline bool same_group(const RobotItem& a, const RobotItem& b) {
  return same_kit(a, b) && !a.params && !b.params;
}

inline bool same_params(const std::optional<Element>& a, const std::optional<Element>& b) {
  return a && b ? same_settings(*a, *b) : !a && !b;
}

}  // namespace tandem::core
