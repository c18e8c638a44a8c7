// Adds the bridge to the catalog, with its own attributes of <bridge>.
#pragma once
#include "bridges/bridge_type.hpp"
#include "bridges/eyebot/bridge.hpp"
#include "bridges/inspector_type.hpp"
#include "hal/catalog.hpp"

namespace tandem::bridges::eyebot {

void register_bridge(hal::Registrar& registrar);

/// What the file says of an eye-bot, as its bridge needs it. Errors: those of BridgeType::make.
hal::Result<BridgeSettings> settings_for(const BridgeRequest& request);
const InspectorType& inspector_type() noexcept;

}  // namespace tandem::bridges::eyebot
