// Inspector of e-pucks on a link, for the catalog.
#pragma once
#include "bridges/inspector_type.hpp"

namespace tandem::bridges::epuck {

const InspectorType& inspector_type() noexcept;

}  // namespace tandem::bridges::epuck
