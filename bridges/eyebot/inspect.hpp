// Inspector of eye-bots on a network, for the catalog.
#pragma once
#include "bridges/inspector_type.hpp"

namespace tandem::bridges::eyebot {

const InspectorType& inspector_type() noexcept;

}  // namespace tandem::bridges::eyebot
