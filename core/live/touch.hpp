// What people do to a running simulation, as commands in JSON: move, add, remove, light, halt, release, set, press,
// reload.
#pragma once
#include <string>
#include <string_view>

#include "core/sim/world.hpp"
#include "hal/json/json.hpp"
#include "hal/result.hpp"

namespace tandem::core {

/// Whether a command of this name is one for `touch`.
bool is_touch(std::string_view name) noexcept;

/// Carries out a command between two ticks, and completes it with what it left open (an id), so that it does the same
/// when it is repeated. @returns members for the answer. Errors: what is wrong with it, or what is in the way; nothing
/// has changed then.
///
///   {"do": "move", "robot" | "object" | "light": id, "x", "y", "z", "heading"}     what is missing stays
///   {"do": "add", "robot": {"controller", "kind", "id", "x", "y", "z", "heading"}}
///   {"do": "add", "object": {"shape": "box" | "cylinder", "id", "x", "y", "z", "heading", "size_x", "size_y" |
///                            "radius", "height", "movable", "mass"}}
///   {"do": "add", "light": {"id", "x", "y", "z", "intensity", "color": "#rrggbb"}}
///   {"do": "remove", "robot" | "object" | "light": id}
///   {"do": "light", "light": id, "intensity", "color"}
///   {"do": "halt" | "release", "robot": id or "*"}
///   {"do": "set", "owner", "control", "value"}, {"do": "press", "owner", "control"}
///   {"do": "reload", "controller", "files": {name: text}}                   core/live/source_files.hpp
hal::Result<hal::Json> touch(World& world, hal::Json& command);

/// Whether the second continues the first, like the steps of a drag: one of them is enough.
bool continues(const hal::Json& first, const hal::Json& second);

}  // namespace tandem::core
