// The sources of examples/plugins, as the program carries them for `tandem plugin new`.
#pragma once
#include <span>
#include <string_view>

namespace tandem::app {

struct TemplateFile {
  std::string_view name;  ///< of the file in examples/plugins
  std::string_view text;
};

/// Written by the build.
std::span<const TemplateFile> plugin_templates();

}  // namespace tandem::app
