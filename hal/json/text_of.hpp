// Texts out of JSON objects that somebody else may have written.
#pragma once
#include <string>
#include <string_view>

#include "hal/json/json.hpp"

namespace tandem::hal {

/// The text at `key`; `otherwise` where there is none, or something that is no text.
inline std::string text_of(const Json& object, const char* key, std::string_view otherwise = {}) {
  const auto found = object.find(key);
  return found != object.end() && found->is_string() ? found->get<std::string>() : std::string(otherwise);
}

}  // namespace tandem::hal
