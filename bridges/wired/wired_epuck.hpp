// An e-puck's bridge and firmware on one serial line.
#pragma once
#include "bridges/wired/wired_robot.hpp"

namespace tandem::bridges::wired {

MadeWiredRobot make_wired_epuck(const WiredRequest& request);

}  // namespace tandem::bridges::wired
