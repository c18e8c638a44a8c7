// Adds the bridge to the catalog, with its own attributes of <bridge>.
#pragma once
#include "hal/catalog.hpp"

namespace tandem::bridges::epuck {

void register_bridge(hal::Registrar& registrar);

}  // namespace tandem::bridges::epuck
