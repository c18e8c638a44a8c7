// Robots from the inside, as JSON: every port field by field, published state, parameters.
#pragma once
#include <string>
#include <vector>

#include "core/sim/world.hpp"
#include "hal/json/json.hpp"

namespace tandem::core {

/// {"tick", "robots": [{"id", "alive", "kind", "controller", "pose", "velocity", "halted", "ports", "published",
/// "params", "controls"}, …]}: as docs/view-protocol.md describes it. A robot that is gone has "alive": false alone.
/// Between steps.
hal::Json inspection_of(World& world, const std::vector<std::string>& robots);

}  // namespace tandem::core
