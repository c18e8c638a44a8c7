// Checks an experiment's real robots, before any link is opened.
#pragma once
#include "core/scenario/scenario.hpp"
#include "hal/catalog.hpp"

namespace tandem::mixed_reality {

/// Adds every problem of the scenario's <bridge> elements: a link that does not suit the robot or is none, no way to
/// re-arm, what the kind's own configuration lacks, two robots behind one link (and, where several share a link, one
/// name).
void check_bridges(const core::Scenario& scenario, const hal::Catalog& catalog, core::Problems& problems);

}  // namespace tandem::mixed_reality
