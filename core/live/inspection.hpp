// Robots from the inside, as JSON: every port field by field, published state, parameters.
#pragma once
#include <cstdint>
#include <string>
#include <vector>

#include "core/sim/world.hpp"
#include "hal/json/json.hpp"

namespace tandem::core {

/// {"tick", "robots": [{"id", "alive", "kind", "controller", "pose", "velocity", "halted", "ports", "published",
/// "params", "controls"}, …]}: as docs/view-protocol.md describes it. A robot that is gone has "alive": false alone.
/// Between steps.
hal::Json inspection_of(World& world, const std::vector<std::string>& robots);

/// The same after so many ticks of a space alone: without "params" and "controls"; "controller" is the name of the
/// controller's class.
hal::Json inspection_of(const Space& space, hal::Tick done, std::int64_t ticks_per_second,
                        const std::vector<std::string>& robots);

/// Names of all that controllers publish, but for lists of values.
std::vector<std::string> published_names(const Space& space);
/// {"name", "values", "words"}: the value of each robot under that name, in the order of the members that viewers
/// know; null: nothing. "words" of an enumeration: its values from 0 on.
hal::Json published_values(const Space& space, const std::string& name);

}  // namespace tandem::core
