// Adds the bridge to the catalog, with its own attributes of <bridge>.
#pragma once
#include "hal/catalog.hpp"

namespace tandem::bridges::footbot {

void register_bridge(hal::Registrar& registrar);

}  // namespace tandem::bridges::footbot
