// The kinds of robots whose data sheets stand in this folder.
#pragma once
#include "hal/catalog.hpp"

namespace tandem::hal {

void register_robots(Registrar& registrar);

}  // namespace tandem::hal
