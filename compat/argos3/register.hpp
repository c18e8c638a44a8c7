// Entries of the module `argos3`.
#pragma once
#include "hal/catalog.hpp"

namespace tandem::app {

void register_argos3(hal::Registrar& registrar);

}  // namespace tandem::app
