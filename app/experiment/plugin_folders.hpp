// Folders in which plug-ins are looked for.
#pragma once
#include <filesystem>
#include <vector>

namespace tandem::app {

/// Where plug-ins are looked for: TANDEM_PLUGIN_PATH (folders separated by ':'), then the folder of this
/// program's own libraries.
std::vector<std::filesystem::path> plugin_folders();

/// Every plug-in file in those folders.
std::vector<std::filesystem::path> plugin_files();

}  // namespace tandem::app
