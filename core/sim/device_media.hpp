// Resolves the media that devices name in experiment files.
#pragma once
#include "core/scenario/scenario.hpp"
#include "hal/catalog.hpp"

namespace tandem::core {

/// Sets the medium of every listed device that works in one and names it. What the medium's element says holds for the
/// device then, where that has an option of the same name and leaves it out. Problem: there is no such medium.
void name_media(Scenario& scenario, const hal::Catalog& catalog, Problems& problems);

}  // namespace tandem::core
