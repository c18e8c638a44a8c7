// Every class of ports that Tandem's own robots have.
#pragma once
#include "hal/catalog.hpp"

namespace tandem::hal {

/// Adds all sensors and actuators that controllers may ask for.
void register_ports(Registrar& registrar);

}  // namespace tandem::hal
