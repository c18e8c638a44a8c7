// Opens plug-ins and keeps what they offer.
#pragma once
#include <filesystem>
#include <map>
#include <memory>
#include <string>
#include <vector>

#include "hal/plugin.hpp"
#include "hal/result.hpp"

namespace tandem::hal {

/// Opened plug-ins and the types they registered. Must outlive every object made by them.
class PluginLoader {
 public:
  /// `search` are the folders in which a library is looked for after the path as written.
  explicit PluginLoader(std::vector<std::filesystem::path> search);
  ~PluginLoader();
  PluginLoader(const PluginLoader&) = delete;
  PluginLoader& operator=(const PluginLoader&) = delete;

  /// Opens `library` ("build/lib/libx.so", "libx", "x": extension and prefix optional) once, however often asked.
  /// Errors: not found (names every place looked at), not loadable, not a plug-in, built for another ABI, throws while
  /// it registers, registers what is incomplete.
  Status open(const std::string& library);

  /// The file that `library` resolves to.
  Result<std::filesystem::path> find(const std::string& library) const;

  /// What the plug-in `library` registered under `name`, or under its only name when `name` is empty. Opens it if
  /// needed. Errors: as `open`; no such name (lists those there are).
  Result<const void*> get(const std::string& library, std::string_view category, std::string_view name);
  Result<const ControllerType*> controller(const std::string& library, std::string_view name);

  struct Entry {
    std::string library, category, name;
    const void* type;
  };
  const std::vector<Entry>& entries() const noexcept { return entries_; }

 private:
  std::vector<std::filesystem::path> search_;
  Status register_types(const std::string& path, const PluginInfo& info);

  std::map<std::string, void*> handles_;         // by resolved path
  std::map<std::string, std::string> unusable_;  // by resolved path: why
  std::vector<Entry> entries_;
};

}  // namespace tandem::hal
