#include <argos3/core/utility/plugins/dynamic_loading.h>
#include <filesystem>
#include <mutex>
#include <sstream>
#include <vector>

namespace argos {
namespace {

namespace fs = std::filesystem;

std::map<std::string, CDynamicLoading::TDLHandle>& open_libraries() {
  static auto* const all = new std::map<std::string, CDynamicLoading::TDLHandle>;
  return *all;
}

std::vector<fs::path> folders() {
  std::vector<fs::path> all;
  const char* const path = std::getenv("ARGOS_PLUGIN_PATH");
  std::istringstream in(path == nullptr ? "" : path);
  for (std::string folder; std::getline(in, folder, ':');) {
    if (!folder.empty()) all.emplace_back(folder);
  }
  return all;
}

}  // namespace

CDynamicLoading::TDLHandle CDynamicLoading::LoadLibrary(const std::string& library) {
  const auto known = open_libraries().find(library);
  if (known != open_libraries().end()) return known->second;
  std::vector<fs::path> places = folders();
  places.insert(places.begin(), fs::path());
  std::error_code ignored;
  for (const fs::path& folder : places) {
    for (const std::string& name : {library, library + ".so"}) {
      if (!fs::is_regular_file(folder / name, ignored)) continue;
      const TDLHandle handle = dlopen((folder / name).c_str(), RTLD_NOW | RTLD_GLOBAL);
      if (handle == nullptr) THROW_ARGOSEXCEPTION("the library \"" << library << "\" does not load: " << dlerror())
      return open_libraries()[library] = handle;
    }
  }
  THROW_ARGOSEXCEPTION("the library \"" << library << "\" is not there; correct its path, or add its folder to "
                                        << "ARGOS_PLUGIN_PATH")
}

void CDynamicLoading::UnloadLibrary(const std::string& library) {
  const auto known = open_libraries().find(library);
  if (known == open_libraries().end()) THROW_ARGOSEXCEPTION("the library \"" << library << "\" is not loaded")
  dlclose(known->second);
  open_libraries().erase(known);
}

void CDynamicLoading::LoadAllLibraries() {
  std::error_code ignored;
  for (const fs::path& folder : folders()) {
    for (const auto& entry : fs::directory_iterator(folder, ignored)) {
      if (entry.path().extension() != ".so") continue;
      try {
        LoadLibrary(entry.path().string());
      } catch (const CARGoSException& e) {
        LOGERR << "[WARNING] " << e.what() << std::endl;
      }
    }
  }
}

void CDynamicLoading::UnloadAllLibraries() {
  for (const auto& entry : open_libraries()) dlclose(entry.second);
  open_libraries().clear();
}

}  // namespace argos
