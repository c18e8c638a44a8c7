// What this program contains: the one page that knows every folder.
#pragma once
#include <filesystem>
#include <string>
#include <vector>

#include "core/config/reader.hpp"
#include "hal/plugin_loader.hpp"

namespace tandem::app {

/// Names that experiment files may use.
const core::KnownNames& known_names();

/// Where plug-ins are looked for: TANDEM_PLUGIN_PATH (folders separated by ':'), then the lib folder beside this
/// program.
std::vector<std::filesystem::path> plugin_folders();

/// Every plug-in file in those folders.
std::vector<std::filesystem::path> plugin_files();

}  // namespace tandem::app
