// JSON: values in the order in which they were added, to text and back.
#pragma once
#include <nlohmann/json.hpp>
#include <string>
#include <string_view>

#include "hal/result.hpp"

namespace tandem::hal {

/// `json["key"] = value`; members keep their order. Numbers that JSON cannot hold (NaN, infinity) become null.
using Json = nlohmann::ordered_json;

/// One line without a line end. Bytes that are no UTF-8 become U+FFFD.
std::string to_text(const Json& json);

/// One object. Errors: no JSON, with the place; no object; a name that stands twice.
Result<Json> parse_json_object(std::string_view text);

}  // namespace tandem::hal
