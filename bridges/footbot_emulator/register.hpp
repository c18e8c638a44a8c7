// Adds the emulator to the catalog.
#pragma once
#include "hal/catalog.hpp"

namespace tandem::bridges::footbot_emulator {

void register_emulator(hal::Registrar& registrar);

}  // namespace tandem::bridges::footbot_emulator
