// The bridge to real Thymios, and how the guardian stops them.
#pragma once
#include "hal/catalog.hpp"

namespace tandem::bridges::thymio {

void register_bridge(hal::Registrar& registrar);

}  // namespace tandem::bridges::thymio
