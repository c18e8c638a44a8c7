// Adds the trackers to the catalog.
#pragma once
#include "hal/catalog.hpp"

namespace tandem::bridges::trackers {

void register_trackers(hal::Registrar& registrar);

}  // namespace tandem::bridges::trackers
