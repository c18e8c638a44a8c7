// A foot-bot's bridge and its modules on one CAN bus.
#pragma once
#include "bridges/wired/wired_robot.hpp"

namespace tandem::bridges::wired {

MadeWiredRobot make_wired_footbot(const WiredRequest& request);

}  // namespace tandem::bridges::wired
