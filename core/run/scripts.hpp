// Files that controllers run (hal/source_files.hpp), as they are now.
#pragma once
#include <cstddef>
#include <vector>

#include "core/sim/world.hpp"
#include "hal/json/json.hpp"
#include "hal/source_files.hpp"

namespace tandem::core {

/// Robots of a configuration, in the order in which they came.
std::vector<RobotId> robots_of(const World& world, std::size_t config);
/// The same as they lie in memory: those that share something are next to each other.
std::vector<RobotId> robots_in_order(const World& world, std::size_t config);

/// Those that a robot's controller runs now; empty: none.
std::vector<hal::SourceFile> source_files(World& world, RobotId robot);

/// {"<id of a configuration>": [{"name", "path", "text"}, …]}, of configurations whose robots run files now.
hal::Json source_files(World& world);

}  // namespace tandem::core
