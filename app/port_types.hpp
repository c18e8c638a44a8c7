// Every class of ports that there is.
#pragma once
#include <span>

#include "hal/port.hpp"

namespace tandem::app {

/// All sensors and actuators that controllers may ask for.
std::span<const hal::PortType* const> all_port_types();

}  // namespace tandem::app
