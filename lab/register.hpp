// Entries of the module `lab`.
#pragma once
#include "hal/catalog.hpp"

namespace tandem::app {

void register_lab(hal::Registrar& registrar);

}  // namespace tandem::app
