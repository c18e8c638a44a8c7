// Manuals of elements, made of the descriptions that also read them.
#pragma once
#include <string>

#include "core/config/reading.hpp"
#include "hal/element.hpp"

namespace tandem::core {

/// Of one described element, without its parents.
template <class T>
ElementManual manual_of() {
  T value{};
  ManualWriter writer;
  value.describe(writer);
  const schema::ElementInfo& info = T::kElement;
  std::string required;
  for (const std::string& name : words(info.required)) required += (required.empty() ? "  must have: " : ", ") + name;
  if (!required.empty()) required += "\n";
  return {std::string(info.name), {}, std::string(info.doc), required + writer.text(), words(info.children)};
}

}  // namespace tandem::core
