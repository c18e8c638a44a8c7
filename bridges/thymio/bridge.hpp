// A real Thymio behind the control interface (bridges/aseba/node_bridge.hpp).
//
// The program in the robot stops it when it heard nothing of the hub for the command time-out, whatever has become of
// hub, guardian and link. Only when the program itself is gone, by somebody else's loading another, does the robot do
// as that one says.
#pragma once
#include "bridges/aseba/node_bridge.hpp"
#include "bridges/thymio/driver.hpp"

namespace tandem::bridges::thymio {

using BridgeSettings = aseba::NodeBridgeSettings<ThymioParts>;
using ThymioBridge = aseba::NodeBridge<ThymioParts>;

}  // namespace tandem::bridges::thymio
