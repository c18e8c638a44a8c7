// Reads one flat JSON object (RFC 8259): no objects or lists in it.
#pragma once
#include <map>
#include <string>
#include <string_view>
#include <variant>

#include "hal/result.hpp"

namespace tandem::app {

/// Null is monostate.
using FlatValue = std::variant<std::monostate, bool, double, std::string>;
using FlatObject = std::map<std::string, FlatValue>;

/// An error says what was found at which character, from 1. Names that stand twice are errors, too.
hal::Result<FlatObject> parse_flat_json(std::string_view text);

}  // namespace tandem::app
