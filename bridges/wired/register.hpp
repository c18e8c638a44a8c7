// Adds the wired robots to the catalog.
#pragma once
#include "hal/catalog.hpp"

namespace tandem::bridges::wired {

void register_wired_robots(hal::Registrar& registrar);

}  // namespace tandem::bridges::wired
