// Inspector of foot-bots on a link, for the catalog.
#pragma once
#include "bridges/inspector_type.hpp"

namespace tandem::bridges::footbot {

const InspectorType& inspector_type() noexcept;

}  // namespace tandem::bridges::footbot
