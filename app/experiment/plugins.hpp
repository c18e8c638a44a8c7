// The plug-ins of one call of the program, opened in the order that docs/plugins.md states.
#pragma once
#include <cstddef>
#include <memory>
#include <optional>
#include <string>
#include <vector>

#include "core/config/reader.hpp"
#include "hal/plugin_loader.hpp"

namespace tandem::app {

/// A loader with the parts that come with this program.
hal::PluginLoader make_loader();

/// Loads the modules that elements of a file need. False: complained.
bool need_modules_for(hal::PluginLoader& loader, const core::Element& root);

/// Opens the libraries of `--plugin`, for commands that read no experiment. Complains where one cannot be.
bool open_plugins(hal::PluginLoader& loader, const std::vector<std::string>& libraries);

/// Opens all that is in the plug-in folders. Says what cannot be opened.
void open_plugin_folders(hal::PluginLoader& loader);

/// The loader's catalog with the kinds of a file, which it holds.
struct KindsOfFile {
  std::vector<core::KindConfig> kinds;
  hal::Catalog catalog;
};

/// Of this process.
std::ptrdiff_t thread_count();

/// An experiment file on its way to a scenario, with its plug-ins and those of `--plugin`. Errors is printed.
class ExperimentReading {
 public:
  /// `loader` must outlive this, and all that is made with its catalog.
  /// `strict`: ignored content of ARGoS files is an error.
  ExperimentReading(hal::PluginLoader& loader, const std::vector<std::string>& plugins, bool strict = false);

  /// Reads the file, judges all plug-ins, and opens those with what stops real robots: what a guardian needs. Starts no
  /// thread. False: complained.
  bool open(const std::string& path, const std::vector<std::string>& overrides);
  /// The same of settings that a record or a report kept; `name` stands for their file.
  bool open_text(const std::string& text, const std::string& name, const std::vector<std::string>& overrides);
  /// Whether a robot of the file has a <bridge>, leaving out those of the ids `without`.
  bool has_real_robots(const std::vector<std::string>& without) const;
  /// Opens the other plug-ins, and judges the file by the catalog that is then complete.
  std::optional<core::Scenario> read();
  /// Whether the file, or a setting beside it, said how fast its run goes: <time mode="…"/>. Once it is read.
  bool says_pace() const noexcept { return says_pace_; }

 private:
  struct Library {
    std::string name;
    int line = 0;  ///< of the file; 0: --plugin
    bool stops_robots = false;
  };
  bool take(std::optional<core::ExperimentFile> file, const core::Problems& problems, const std::string& path);
  bool judge();
  bool open_those(bool that_stop_robots);
  void complain_about(const Library& library, const std::string& message) const;

  hal::PluginLoader& loader_;
  bool strict_;
  std::vector<Library> libraries_;
  std::string path_;
  std::optional<core::ExperimentFile> file_;
  bool says_pace_ = false;
};

/// The parts that a file adds to those of the loader: its plug-ins, which are opened, and its kinds of robots. The rest
/// of the file is not judged; it may be a file of kinds alone. Null: complained.
std::unique_ptr<KindsOfFile> kinds_of_file(hal::PluginLoader& loader, const std::string& path);

/// This program's catalog with the kinds of settings that a record kept, in which `name` stands for their file. Opens
/// no plug-ins: kinds that need some, and settings that are none, add nothing.
std::unique_ptr<KindsOfFile> kinds_of_settings(const std::string& text, const std::string& name);

/// All of it, for commands without real robots.
std::optional<core::Scenario> read_or_complain(hal::PluginLoader& loader, const std::vector<std::string>& plugins,
                                               const std::string& path, const std::vector<std::string>& overrides,
                                               bool strict = false);

/// The same of settings that a record or a report kept.
std::optional<core::Scenario> settings_or_complain(hal::PluginLoader& loader, const std::vector<std::string>& plugins,
                                                   const std::string& text, const std::string& name,
                                                   const std::vector<std::string>& overrides);

}  // namespace tandem::app
