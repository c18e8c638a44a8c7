// The sources of examples/plugins, as the program carries them for `tandem plugin new`.
#pragma once
#include "hal/carried_file.hpp"

namespace tandem::app {

/// Written by the build.
std::span<const hal::CarriedFile> plugin_templates();

}  // namespace tandem::app
