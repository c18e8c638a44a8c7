// Adds the bridge to the catalog, with its own attributes of <bridge>.
#pragma once
#include "bridges/inspector_type.hpp"
#include "hal/catalog.hpp"

namespace tandem::bridges::footbot {

void register_bridge(hal::Registrar& registrar);
const InspectorType& inspector_type() noexcept;

}  // namespace tandem::bridges::footbot
