// Parts of plug-ins that an experiment names in <run>.
#pragma once
#include "core/run/run.hpp"
#include "core/scenario/scenario.hpp"
#include "hal/catalog.hpp"

namespace tandem::core {

/// Makes them and adds them to the run of a world whose experiment names them. What a call of theirs does wrong is told
/// as their plug-in's doing. `catalog` must outlive the run. Problems are appended.
void add_named_parts(Run& run, const hal::Catalog& catalog, Problems& problems);

}  // namespace tandem::core
