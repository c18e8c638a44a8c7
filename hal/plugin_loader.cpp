#include "hal/plugin_loader.hpp"

#include <algorithm>
#include <cstdlib>
#include <cxxabi.h>
#include <dlfcn.h>

#include "hal/plugin_call.hpp"
#include "hal/plugin_note.hpp"

namespace tandem::hal {
namespace {

namespace fs = std::filesystem;

/// The names under which `library` may lie in a folder.
std::vector<fs::path> spellings(fs::path library) {
  if (library.extension() == ".dylib") library.replace_extension(".so");  // as files written on a Mac have it
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

/// What the system says of the library that it did not load.
std::string why_not_loaded() {
  const char* const why = dlerror();
  if (why == nullptr) return "unknown reason";
  const std::string text = why;
  constexpr std::string_view kMissing = "undefined symbol: ";
  const std::size_t at = text.find(kMissing);
  if (at == std::string::npos) return text;
  const std::string symbol =
      text.substr(at + kMissing.size(), text.find_first_of(" \t(,", at + kMissing.size()) - at - kMissing.size());
  int status = -1;
  const std::unique_ptr<char, void (*)(void*)> plain(abi::__cxa_demangle(symbol.c_str(), nullptr, nullptr, &status),
                                                     &std::free);
  return "nobody has its symbol " + (status == 0 ? std::string(plain.get()) + " (" + symbol + ")" : symbol) +
         ". Link the library that has it, or build it against the headers of this program";
}

/// The command that makes a library anew, as far as its place tells.
std::string how_to_rebuild(const fs::path& library) {
  std::error_code ignored;
  for (fs::path folder = library.parent_path(); folder.has_relative_path(); folder = folder.parent_path()) {
    if (fs::is_regular_file(folder / "CMakeCache.txt", ignored))
      return "Rebuild it against the headers of this program: cmake --build " + folder.string();
  }
  return "Rebuild it against the headers of this program, in its own build folder: cmake --build FOLDER";
}

/// Null: it does not load, and dlerror tells why.
void* load(const std::string& path) {
  const PluginCall call(&name_library, path.c_str(), 1);
  return dlopen(path.c_str(), RTLD_NOW | RTLD_LOCAL);
}

/// Libraries for ARGoS use one another's classes without being linked, and are loaded beside one another there.
constexpr std::string_view kShares = "argos3";

}  // namespace

PluginLoader::PluginLoader(std::vector<fs::path> search, Catalog inside, OnDemand on_demand)
    : search_(std::move(search)), catalog_(std::move(inside)), on_demand_(on_demand) {
  catalog_.know<Border>();
  catalog_.know<ControllerType>();
}

PluginLoader::~PluginLoader() {
  for (auto& [path, handle] : handles_) dlclose(handle);
}

/// Empty: nowhere; then `looked` names all places.
fs::path PluginLoader::look_for(const std::string& library, std::string& looked) const {
  std::vector<fs::path> places{fs::path{}};
  if (!fs::path(library).is_absolute()) {
    if (!beside_.empty()) places.insert(places.begin(), beside_);
    places.insert(places.end(), search_.begin(), search_.end());
  }
  std::error_code ignored;
  for (const fs::path& folder : places) {
    for (const fs::path& name : spellings(library)) {
      if (fs::is_regular_file(folder / name, ignored)) return fs::weakly_canonical(folder / name);
      looked += "\n    " + (folder / name).string();
    }
  }
  return {};
}

/// A library of ours that is called like the one that is not there: somebody else's, perhaps.
std::string PluginLoader::namesake_of(const std::string& library) const {
  if (!fs::path(library).has_parent_path()) return {};
  std::string ignored;
  const fs::path found = look_for(fs::path(library).filename().string(), ignored);
  return found.empty() ? std::string()
                       : "\n  Another library of that name is " + found.string() + "; library=\"" +
                             fs::path(library).stem().string() + "\", without a folder, takes it.";
}

Result<fs::path> PluginLoader::find(const std::string& library) const {
  std::string looked, again;
  if (fs::path found = look_for(library, looked); !found.empty()) return found;
  const bool ours = !fs::path(library).has_parent_path();  // else a file that its writer made
  if (ours && on_demand_.make != nullptr && on_demand_.make(library)) {
    if (fs::path found = look_for(library, again); !found.empty()) return found;
  }
  return Error{"library '" + library + "' is not there; looked for" + looked +
               "\n  Build it, correct library=\"…\", or add its folder to TANDEM_PLUGIN_PATH." + namesake_of(library)};
}

Status PluginLoader::open(const std::string& library) {
  const Status good = load_once(library);
  if (!good.ok()) return good;
  const std::string path = find(library).value().string();
  if (std::find(plugins_.begin(), plugins_.end(), path) == plugins_.end()) plugins_.push_back(path);
  return {};
}

Status PluginLoader::load_once(const std::string& library) {
  const auto found = find(library);
  if (!found.ok()) return found.error();
  const std::string path = found.value().string();
  if (const auto why = unusable_.find(path); why != unusable_.end()) return Error{why->second};
  if (handles_.contains(path)) return {};
  const auto note = judge(path);
  if (!note.ok()) return note.error();

  void* handle = load(path);
  if (handle == nullptr) {
    const std::string why = why_not_loaded();
    if (note.value().uses(kShares)) {
      for (const auto& [open, unused] : handles_) {
        const auto other = read_plugin_note(open);
        if (other.ok() && other.value().uses(kShares)) dlopen(open.c_str(), RTLD_NOW | RTLD_NOLOAD | RTLD_GLOBAL);
      }
      handle = load(path);
    }
    if (handle == nullptr) return Error{"library '" + path + "' does not load: " + why};
  }
  const auto* info = static_cast<const PluginInfo*>(dlsym(handle, "tandem_plugin"));
  if (info == nullptr) {
    dlclose(handle);
    return Error{"library '" + path +
                 "' hides the symbol tandem_plugin: link it without a version script or export list"};
  }
  handles_.emplace(path, handle);  // it stays open even when it is of no use: what it threw may be of its own types
  const Status registered = register_types(path, *info, note.value());
  if (!registered.ok()) unusable_.emplace(path, registered.error().message);
  return registered;
}

Result<PluginNote> PluginLoader::inspect(const std::string& library) {
  const auto found = find(library);
  if (!found.ok()) return found.error();
  return judge(found.value().string());
}

Result<PluginNote> PluginLoader::judge(const std::string& path) {
  auto note = read_plugin_note(path);
  if (!note.ok()) return Error{"library '" + path + "' " + note.error().message};
  if (on_demand_.complete != nullptr) {
    if (const Status completed = on_demand_.complete(*this, note.value()); !completed.ok())
      return Error{"library '" + path + "': " + completed.error().message};
  }
  if (const std::string why = misfit(note.value(), catalog_.surfaces()); !why.empty())
    return Error{"library '" + path + "' " + why + "\n  " + how_to_rebuild(path)};
  return note;
}

Status PluginLoader::register_types(const std::string& path, const PluginInfo& info, const PluginNote& note) {
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
  for (const Catalog::Entry& e : with.entries()) {
    if (e.origin == path && !note.uses(e.category))
      return Error{library + " registers the " + e.category + " '" + e.name +
                   "' past its note; add it with hal::Registrar::add(entry)"};
  }
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
  for (const Catalog::Entry& e : catalog_.entries()) {  // the program's own
    if (library == Catalog::kInside && e.origin == library && e.category == category && e.layout == layout &&
        e.name == name)
      return e.entry;
  }
  if (const Status opened = load_once(library); !opened.ok()) return opened.error();
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
