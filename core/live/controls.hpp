// Controls of hooks and controllers as JSON: listed, set, pressed.
#pragma once
#include <string>
#include <string_view>
#include <vector>

#include "core/run/scripts.hpp"
#include "core/sim/world.hpp"
#include "hal/json/json.hpp"
#include "hal/result.hpp"

namespace tandem::core {

// Owners are named "hook:<its class>" (with "#2" behind it for the second of that class), "controller:<id of a
// configuration>", for all robots that have it, and "robot:<id>", for one of them.

/// All controls of hooks and of controllers' configurations (with the values of the first robot of each):
/// [{"owner", "name", "kind": "number" | "integer" | "flag" | "choice" | "text" | "button", "value", "min", "max",
/// "unit", "options", "doc"}]. Numbers are in `unit`.
hal::Json controls_json(World& world);
/// Those of one robot's controller.
hal::Json controls_json(World& world, RobotId robot);

/// Gives a control another value, in the unit in which it is listed. Errors: no such owner or control; not a value of
/// its kind; beyond its range; what the owner throws.
hal::Status set_control(World& world, const std::string& owner, std::string_view name, const hal::Json& value);
hal::Status press_button(World& world, const std::string& owner, std::string_view name);

}  // namespace tandem::core
