// A real foot-bot behind the control interface (bridges/aseba/node_bridge.hpp).
//
// Modules have no watchdog: when the link is cut while the robot moves, it drives on until the link is back; when this
// process is killed, until a guardian (bridges/guardian), where one was started, stops it. The remedy is the program
// that the map gives the motors' modules (<dead_man>, bridges/aseba/dead_man.hpp): it sets the speed to 0 when it was
// told nothing for a while.
#pragma once
#include "bridges/aseba/node_bridge.hpp"
#include "bridges/footbot/driver.hpp"

namespace tandem::bridges::footbot {

using BridgeSettings = aseba::NodeBridgeSettings<FootbotParts>;
using BridgeStatus = aseba::NodeBridgeStatus<FootbotParts>;
using FootbotBridge = aseba::NodeBridge<FootbotParts>;

}  // namespace tandem::bridges::footbot
