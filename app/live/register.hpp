// Entries of the module `live`.
#pragma once
#include "hal/catalog.hpp"

namespace tandem::app {

void register_live(hal::Registrar& registrar);

}  // namespace tandem::app
