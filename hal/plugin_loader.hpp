// Opens plug-ins and keeps their entries.
#pragma once
#include <filesystem>
#include <functional>
#include <map>
#include <memory>
#include <string>
#include <vector>

#include "hal/plugin.hpp"
#include "hal/plugin_note.hpp"
#include "hal/result.hpp"

namespace tandem::hal {

/// Opened plug-ins, and the catalog that they add to. Must outlive every object made by them.
class PluginLoader {
 public:
  /// `search` are the folders in which a library is looked for after the path as written. `inside` is what there is
  /// without any library.
  explicit PluginLoader(std::vector<std::filesystem::path> search, Catalog inside = {})
      : PluginLoader(std::move(search), std::move(inside), {}) {}
  /// What a program does whose parts are loaded, or even built, when they are needed.
  struct OnDemand {
    /// Completes the catalog by what a library's note names. Error: it cannot, and the library is not loaded.
    Status (*complete)(PluginLoader& loader, const PluginNote& note) = nullptr;
    /// Makes a library that was not found. @returns whether to look again.
    bool (*make)(const std::string& library) = nullptr;
  };
  PluginLoader(std::vector<std::filesystem::path> search, Catalog inside, OnDemand on_demand);
  ~PluginLoader();
  PluginLoader(const PluginLoader&) = delete;
  PluginLoader& operator=(const PluginLoader&) = delete;

  /// Libraries are looked for in the folder of this file first: they are named by it.
  void look_beside(const std::filesystem::path& file) { beside_ = file.parent_path(); }

  /// Opens `library` ("build/lib/libx.so", "libx", "x": extension and prefix optional) once, however often asked.
  /// Errors: those of `inspect`; not loadable, throws while it registers, registers what is incomplete or what the
  /// catalog refuses.
  Status open(const std::string& library);

  /// Judges `library` by its file alone; nothing of it runs. Errors: not found (names every place looked at), no
  /// plug-in, for another processor, built against other layouts than this program's.
  Result<PluginNote> inspect(const std::string& library);

  /// The file that `library` resolves to.
  Result<std::filesystem::path> find(const std::string& library) const;

  /// What the plug-in `library` registered under `name`, or under its only name when `name` is empty. Opens it if
  /// needed. The library `Catalog::kInside` is the program itself. Errors: as `open`; no such name (lists those there
  /// are).
  template <class T>
  Result<const T*> get(const std::string& library, std::string_view name) {
    const auto found = get(library, T::kCategory, entry_layout<T>(), name);
    if (!found.ok()) return found.error();
    return static_cast<const T*>(found.value());
  }
  Result<const ControllerType*> controller(const std::string& library, std::string_view name) {
    return get<ControllerType>(library, name);
  }

  /// The libraries that were opened for all that they bring, in this order; those of `get` are not among them.
  const std::vector<std::string>& plugins() const noexcept { return plugins_; }

  /// Adds to what there is without any library.
  Status add_inside(const std::function<void(Registrar&)>& fill) {
    return catalog_.add_from(std::string(Catalog::kInside), fill);
  }

  /// What there is now; entries of a library have its resolved path as their origin.
  const Catalog& catalog() const noexcept { return catalog_; }

 private:
  Result<const void*> get(const std::string& library, std::string_view category, std::uint64_t layout,
                          std::string_view name);
  Status load_once(const std::string& library);
  Result<PluginNote> judge(const std::string& path);
  std::filesystem::path look_for(const std::string& library, std::string& looked) const;
  std::string namesake_of(const std::string& library) const;
  Status register_types(const std::string& path, const PluginInfo& info, const PluginNote& note);

  std::filesystem::path beside_;
  std::vector<std::filesystem::path> search_;
  std::map<std::string, void*> handles_;         // by resolved path
  std::map<std::string, std::string> unusable_;  // by resolved path: why
  std::vector<std::string> plugins_;             // resolved paths
  Catalog catalog_;
  OnDemand on_demand_;
};

}  // namespace tandem::hal
