// The kinds of real robots that there are bridges to, and how each bridge is made from an experiment file.
#pragma once
#include <memory>
#include <span>
#include <string_view>

#include "bridges/robot_bridge.hpp"
#include "bridges/send_permit.hpp"
#include "core/scenario/scenario.hpp"
#include "hal/log.hpp"
#include "hal/result.hpp"
#include "mixed_reality/safety/battery_watch.hpp"

namespace tandem::mixed_reality {

/// Whom to reach.
struct BridgeRequest {
  const core::RobotItem& item;  ///< `item.bridge` is set
  const core::ControllerConfig& controller;
  std::int64_t ticks_per_second = 10;
  std::uint64_t seed = 1;
  bridges::SendPermit permit = {};  ///< asked before everything that is said to the robot
  /// The clock that shows the date, for robots that are told it; null: the system's.
  hal::TimeNs (*unix_clock)() noexcept = nullptr;
};

using MadeBridge = hal::Result<std::unique_ptr<bridges::RobotBridge>>;

/// One kind's bridge. `make` does not wait for the robot.
struct BridgeType {
  std::string_view kind;
  MadeBridge (*make)(const BridgeRequest& request, const hal::Log& log);
  /// The errors of `make`, without making anything.
  hal::Status (*check)(const core::RobotItem& item, std::int64_t ticks_per_second);
  BatteryLimit battery;  ///< from its data sheet
};
std::span<const BridgeType> bridge_types() noexcept;
/// When a robot of this kind is to be stopped for its battery.
BatteryLimit battery_limit(std::string_view kind) noexcept;

/// Makes the bridge that the robot's kind needs; both `tandem run` and `tandem robot` do so. Errors: no bridge for that
/// kind; a link that does not suit it; what its own configuration lacks.
hal::Status check_bridge(const core::RobotItem& item, std::int64_t ticks_per_second);
MadeBridge make_bridge(const BridgeRequest& request, const hal::Log& log);

}  // namespace tandem::mixed_reality
