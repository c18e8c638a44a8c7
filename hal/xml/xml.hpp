// XML in, plain elements out.
#pragma once
#include <optional>
#include <string>

#include "hal/element.hpp"

namespace tandem::hal {

/// Reads a file. Problems (missing, unreadable, not XML) are appended and nothing is returned then.
std::optional<Element> read_xml_file(const std::string& path, Problems& problems);

/// The same from text; `name` stands for the file in messages.
std::optional<Element> read_xml_text(const std::string& text, const std::string& name, Problems& problems);

/// The element and its children as XML text.
std::string to_xml(const Element& element);

}  // namespace tandem::hal
