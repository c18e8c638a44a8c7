#include "app/experiment/plugin_folders.hpp"

#include <algorithm>
#include <cstdlib>

#include "hal/library_folder.hpp"

namespace tandem::app {

namespace fs = std::filesystem;

std::vector<fs::path> plugin_folders() {
  std::vector<fs::path> folders;
  if (const char* path = std::getenv("TANDEM_PLUGIN_PATH"); path != nullptr) {
    std::string text = path;
    for (std::size_t at = 0; at <= text.size();) {
      const std::size_t colon = std::min(text.find(':', at), text.size());
      if (colon > at) folders.emplace_back(text.substr(at, colon - at));
      at = colon + 1;
    }
  }
  if (fs::path own = hal::library_folder(); !own.empty()) folders.push_back(std::move(own));
  return folders;
}

std::vector<fs::path> plugin_files() {
  std::vector<fs::path> files;
  for (const fs::path& folder : plugin_folders()) {
    std::error_code error;
    for (const auto& entry : fs::directory_iterator(folder, error)) {
      if (entry.path().extension() == ".so") files.push_back(entry.path());
    }
  }
  std::sort(files.begin(), files.end());
  return files;
}

}  // namespace tandem::app
