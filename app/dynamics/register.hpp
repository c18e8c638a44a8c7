// Entries of the module `dynamics`.
#pragma once
#include "hal/catalog.hpp"

namespace tandem::app {

void register_dynamics(hal::Registrar& registrar);

}  // namespace tandem::app
