// The layers that come with the program.
#pragma once
#include "hal/catalog.hpp"

namespace tandem::core {

void register_layers(hal::Registrar& registrar);

}  // namespace tandem::core
