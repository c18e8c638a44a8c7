// The emulated Thymio, for the catalog.
#pragma once
#include "hal/catalog.hpp"

namespace tandem::bridges::thymio_emulator {

void register_emulator(hal::Registrar& registrar);

}  // namespace tandem::bridges::thymio_emulator
