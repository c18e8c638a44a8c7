#include "hal/plugin_loader.hpp"

#include <algorithm>
#include <dlfcn.h>

#include "hal/plugin_call.hpp"

namespace tandem::hal {
namespace {

namespace fs = std::filesystem;

/// The names under which `library` may lie in a folder.
std::vector<fs::path> spellings(const fs::path& library) {
  std::vector<fs::path> names{library};
  const std::string file = library.filename().string();
  const bool has_extension = library.extension() == ".so";
  const auto with = [&](const std::string& name) { names.push_back(library.parent_path() / name); };
  if (!has_extension) with(file + ".so");
  if (!file.starts_with("lib")) with("lib" + file + (has_extension ? "" : ".so"));
  return names;
}

/// Whether a type of controllers has all that a world calls.
bool complete(const ControllerType& type) noexcept {
  return type.read_params != nullptr && type.construct != nullptr && type.step_row != nullptr &&
         type.destroy != nullptr && type.size != 0 && type.align != 0;
}

void name_library(const void* path, std::size_t loading, std::size_t /*index*/, FixedText& out) noexcept {
  out << "library '" << static_cast<const char*>(path) << "', while it "
      << (loading != 0 ? "was loaded," : "registered its types,");
}

void* load(const std::string& path) {
  const PluginCall call(&name_library, path.c_str(), 1);
  return dlopen(path.c_str(), RTLD_NOW | RTLD_LOCAL);
}

}  // namespace

PluginLoader::PluginLoader(std::vector<fs::path> search, Catalog inside)
    : search_(std::move(search)), catalog_(std::move(inside)) {}

PluginLoader::~PluginLoader() {
  for (auto& [path, handle] : handles_) dlclose(handle);
}

Result<fs::path> PluginLoader::find(const std::string& library) const {
  std::string looked;
  std::vector<fs::path> places{fs::path{}};
  if (!fs::path(library).is_absolute()) places.insert(places.end(), search_.begin(), search_.end());
  for (const fs::path& folder : places) {
    for (const fs::path& name : spellings(library)) {
      std::error_code ignored;
      if (fs::is_regular_file(folder / name, ignored)) return fs::weakly_canonical(folder / name);
      looked += "\n    " + (folder / name).string();
    }
  }
  // A file written for another build tree: the library's own name, in our folders.
  for (const fs::path& folder : search_) {
    for (const fs::path& name : spellings(fs::path(library).filename())) {
      std::error_code ignored;
      if (fs::is_regular_file(folder / name, ignored)) return fs::weakly_canonical(folder / name);
    }
  }
  return Error{"library '" + library + "' is not there; looked for" + looked +
               "\n  Build it, correct library=\"…\", or add its folder to TANDEM_PLUGIN_PATH."};
}

Status PluginLoader::open(const std::string& library) {
  const auto found = find(library);
  if (!found.ok()) return found.error();
  const std::string path = found.value().string();
  if (const auto why = unusable_.find(path); why != unusable_.end()) return Error{why->second};
  if (handles_.contains(path)) return {};

  void* handle = load(path);
  if (handle == nullptr) {
    const char* why = dlerror();
    return Error{"library '" + path + "' does not load: " + (why != nullptr ? why : "unknown reason")};
  }
  const auto* info = static_cast<const PluginInfo*>(dlsym(handle, "tandem_plugin"));
  std::string problem;
  if (info == nullptr || info->magic != kPluginMagic) {
    problem = "is not a Tandem plug-in: it has no TANDEM_PLUGIN(…)";
  } else if (info->abi != kAbiNumber) {
    problem = "was built for plug-in ABI " + std::to_string(info->abi) + "; this program has ABI " +
              std::to_string(kAbiNumber) + ". Rebuild it against the headers of this program";
  } else if (info->layout != border_layout()) {
    problem = std::string("was built with another compiler or standard library (") + info->compiler +
              "; this program: " + __VERSION__ + "). Rebuild it with the same settings";
  }
  if (!problem.empty()) {
    dlclose(handle);
    return Error{"library '" + path + "' " + problem};
  }
  handles_.emplace(path, handle);  // it stays open even when it is of no use: what it threw may be of its own types
  const Status registered = register_types(path, *info);
  if (!registered.ok()) unusable_.emplace(path, registered.error().message);
  return registered;
}

Status PluginLoader::register_types(const std::string& path, const PluginInfo& info) {
  const std::string library = "library '" + path + "'";
  if (info.register_all == nullptr) return Error{library + " has no function that registers its types"};
  Catalog with = catalog_;
  Status added;
  try {
    const PluginCall call(&name_library, path.c_str());
    added = with.add_from(path, info.register_all);
  } catch (const std::exception& e) {
    return Error{library + " threw while it registered its types: " + std::string(e.what())};
  } catch (...) {
    return Error{library + " threw while it registered its types"};
  }
  if (!added.ok()) return Error{"library " + added.error().message};
  for (const ControllerType* type : with.all<ControllerType>()) {
    if (complete(*type)) continue;
    return Error{library + " registers the controller '" + std::string(type->name) +
                 "' with a type that lacks functions; make it with controller_type"};
  }
  catalog_ = std::move(with);
  return {};
}

Result<const void*> PluginLoader::get(const std::string& library, std::string_view category, std::uint64_t layout,
                                      std::string_view name) {
  if (const Status opened = open(library); !opened.ok()) return opened.error();
  const std::string path = find(library).value().string();
  std::string names;
  const void* only = nullptr;
  std::size_t count = 0;
  for (const Catalog::Entry& e : catalog_.entries()) {
    if (e.origin != path || e.category != category || e.layout != layout) continue;
    if (e.name == name) return e.entry;
    names += (names.empty() ? "" : ", ") + e.name;
    only = e.entry;
    ++count;
  }
  if (name.empty() && count == 1) return only;
  return Error{"library '" + path + "' has no " + std::string(category) + " '" + std::string(name) +
               "'; it has: " + (names.empty() ? "none" : names)};
}

}  // namespace tandem::hal
