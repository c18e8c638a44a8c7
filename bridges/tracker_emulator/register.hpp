// Adds the emulator to the catalog.
#pragma once
#include "hal/catalog.hpp"

namespace tandem::bridges::tracker_emulator {

void register_emulator(hal::Registrar& registrar);

}  // namespace tandem::bridges::tracker_emulator
