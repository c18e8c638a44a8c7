// Entries of the module `window`.
#pragma once
#include "hal/catalog.hpp"

namespace tandem::app {

void register_window(hal::Registrar& registrar);

}  // namespace tandem::app
