// Folders in which plug-ins are looked for.
#pragma once
#include <filesystem>
#include <vector>

namespace tandem::app {

/// Where a library of a file is looked for: TANDEM_PLUGIN_PATH (folders separated by ':'), the folder of this program's
/// own libraries, and ARGOS_PLUGIN_PATH.
std::vector<std::filesystem::path> plugin_folders();

/// Every plug-in file in the first two of these.
std::vector<std::filesystem::path> plugin_files();

}  // namespace tandem::app
