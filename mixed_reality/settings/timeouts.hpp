// Time-outs of real robots, and how a robot drives again afterwards.
#pragma once
#include "core/scenario/scenario.hpp"
#include "hal/time.hpp"
#include "mixed_reality/safety/rearm.hpp"

namespace tandem::mixed_reality {

/// Time-out of a robot with this bridge, without readings or commands, after which it is stopped: the bridge's
/// `timeout`, but two ticks at least, because it is asked once a tick.
hal::TimeNs lost_after_ns(const core::RobotItem& item, std::int64_t ticks_per_second) noexcept;

/// Re-arming of a robot with this bridge. The text of `rearm` was checked.
RearmParams rearm_params(const core::BridgeConfig& bridge);

}  // namespace tandem::mixed_reality
