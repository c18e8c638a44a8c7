// Files that controllers run (core/run/scripts.hpp): read again while the run goes on.
#pragma once
#include <vector>

#include "core/live/live_run.hpp"
#include "core/run/scripts.hpp"
#include "core/sim/world.hpp"
#include "hal/json/json.hpp"
#include "hal/result.hpp"

namespace tandem::core {

/// Has the robots of a configuration start again with other files; their poses, and all else, stay:
///
///   {"do": "reload", "controller": id, "files": {name: text, …}}
///
/// Completes the files with those that they ask for besides. Robots that their controllers' errors had stopped go on.
/// @returns {"robots": how many started again, "stopped": how many could not}: these stand still. Errors: the command
/// makes no sense; the first robot could not begin: nothing has changed then.
hal::Result<hal::Json> reload(World& world, hal::Json& command);

/// What has the robots of a run that begins run the files of a recorded one: `recorded` as `source_files` gave it
/// there. Nothing for configurations whose files are the same.
std::vector<RepeatedAction> reloads_to(const hal::Json& recorded, World& world);

}  // namespace tandem::core
