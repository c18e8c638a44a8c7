#include "app/experiment/plugin_folders.hpp"

#include <algorithm>
#include <cstdlib>

#include "hal/library_folder.hpp"

namespace tandem::app {

namespace fs = std::filesystem;

namespace {

/// Folders that an environment variable names, separated by ':'.
void add_folders_of(const char* variable, std::vector<fs::path>& folders) {
  const char* const path = std::getenv(variable);
  if (path == nullptr) return;
  const std::string text = path;
  for (std::size_t at = 0; at <= text.size();) {
    const std::size_t colon = std::min(text.find(':', at), text.size());
    if (colon > at) folders.emplace_back(text.substr(at, colon - at));
    at = colon + 1;
  }
}

std::vector<fs::path> own_folders() {
  std::vector<fs::path> folders;
  add_folders_of("TANDEM_PLUGIN_PATH", folders);
  if (fs::path own = hal::library_folder(); !own.empty()) folders.push_back(std::move(own));
  return folders;
}

}  // namespace

std::vector<fs::path> plugin_folders() {
  std::vector<fs::path> folders = own_folders();
  add_folders_of("ARGOS_PLUGIN_PATH", folders);  // of projects that were written for ARGoS
  return folders;
}

std::vector<fs::path> plugin_files() {
  std::vector<fs::path> files;
  for (const fs::path& folder : own_folders()) {
    std::error_code error;
    for (const auto& entry : fs::directory_iterator(folder, error)) {
      if (entry.path().extension() == ".so") files.push_back(entry.path());
    }
  }
  std::sort(files.begin(), files.end());
  return files;
}

}  // namespace tandem::app
