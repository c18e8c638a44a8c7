// The kinds of robots of this folder.
#pragma once
#include "hal/catalog.hpp"

namespace tandem::hal {

void register_robots(Registrar& registrar);

}  // namespace tandem::hal
