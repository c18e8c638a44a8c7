// Entries of the module `pictures`.
#pragma once
#include "hal/catalog.hpp"

namespace tandem::app {

void register_pictures(hal::Registrar& registrar);

}  // namespace tandem::app
