#include "app/experiment/plugins.hpp"

#include <algorithm>
#include <filesystem>

#include "app/catalog.hpp"
#include "app/exit_code.hpp"
#include "app/experiment/plugin_folders.hpp"
#include "app/experiment/reading.hpp"
#include "app/experiment/real_side_type.hpp"
#include "app/module/modules.hpp"
#include "app/process/terminal.hpp"
#include "core/config/kinds.hpp"

namespace tandem::app {

std::ptrdiff_t thread_count() {
  std::error_code ignored;
  return std::distance(std::filesystem::directory_iterator("/proc/self/task", ignored), {});
}

namespace {

/// Whether an element of this name stands anywhere in `element`.
bool names(const core::Element& element, std::string_view name) {
  return element.name == name ||
         std::ranges::any_of(element.children, [&](const core::Element& child) { return names(child, name); });
}

}  // namespace

bool need_modules_for(hal::PluginLoader& loader, const core::Element& root) {
  for (const Module& module : kModules) {
    if (std::ranges::none_of(module.elements, [&](std::string_view name) { return names(root, name); })) continue;
    if (const hal::Status there = need_module(loader, module.name); !there.ok())
      return complain(kBadInput, there.error().message) == kDone;
  }
  return true;
}

hal::PluginLoader make_loader() {
  return hal::PluginLoader(plugin_folders(), catalog(), on_demand());
}

bool open_plugins(hal::PluginLoader& loader, const std::vector<std::string>& libraries) {
  bool good = true;
  for (const std::string& library : libraries) {
    const hal::Status opened = loader.open(library);
    if (!opened.ok()) good = complain(kBadInput, "--plugin: " + opened.error().message) == kDone;
  }
  return good;
}

void open_plugin_folders(hal::PluginLoader& loader) {
  for (const auto& library : plugin_files()) {
    const hal::Status opened = loader.open(library.string());
    if (!opened.ok()) say("warning: " + opened.error().message);
  }
}

ExperimentReading::ExperimentReading(hal::PluginLoader& loader, const std::vector<std::string>& plugins, bool strict)
    : loader_(loader), strict_(strict) {
  for (const std::string& library : plugins) libraries_.push_back({library});
}

void ExperimentReading::complain_about(const Library& library, const std::string& message) const {
  if (library.line == 0) {
    complain(kBadInput, "--plugin: " + message);
  } else {
    print_problems({{path_, library.line, "<plugins>: " + message}});
  }
}

bool ExperimentReading::open(const std::string& path, const std::vector<std::string>& overrides) {
  core::Problems problems;
  auto file = core::open_experiment(path, overrides, problems);
  return take(std::move(file), problems, path);
}

bool ExperimentReading::open_text(const std::string& text, const std::string& name,
                                  const std::vector<std::string>& overrides) {
  core::Problems problems;
  auto file = core::open_experiment_text(text, name, overrides, problems);
  return take(std::move(file), problems, name);
}

bool ExperimentReading::take(std::optional<core::ExperimentFile> file, const core::Problems& problems,
                             const std::string& path) {
  path_ = path;
  file_ = std::move(file);
  print_problems(problems);
  if (!file_) return false;
  if (!need_modules_for(loader_, file_->root)) return false;
  loader_.look_beside(path);
  for (const core::PluginConfig& plugin : core::plugins_of(file_->root))
    libraries_.push_back({plugin.library, plugin.line});
  return judge() && open_those(true);
}

bool ExperimentReading::judge() {
  bool good = true;
  for (Library& library : libraries_) {
    const auto note = loader_.inspect(library.name);
    if (!note.ok()) {
      complain_about(library, note.error().message);
      good = false;
      continue;
    }
    library.stops_robots = note.value().uses("bridge") || note.value().uses("stopper");
  }
  return good;
}

bool ExperimentReading::open_those(bool that_stop_robots) {
  bool good = true;
  for (const Library& library : libraries_) {
    if (library.stops_robots != that_stop_robots) continue;
    const std::ptrdiff_t threads = thread_count();
    hal::Status opened = loader_.open(library.name);
    if (opened.ok() && that_stop_robots && thread_count() != threads)
      opened =
          hal::Error{"library '" + library.name +
                     "' starts a thread while it is loaded, and brings a bridge: the guardian process could not be "
                     "forked safely. Start it when the bridge starts"};
    if (opened.ok()) continue;
    complain_about(library, opened.error().message);
    good = false;
  }
  return good;
}

bool ExperimentReading::has_real_robots(const std::vector<std::string>& without) const {
  return file_ && core::names_real_robots(file_->root, without);
}

std::optional<core::Scenario> ExperimentReading::read() {
  if (!file_ || !open_those(false)) return std::nullopt;
  core::Problems problems;
  const core::Element* const framework = file_->root.child("framework");
  const core::Element* const time = framework != nullptr ? framework->child("time") : nullptr;
  says_pace_ = time != nullptr && time->attribute("mode") != nullptr;
  auto scenario = core::read_experiment(std::move(*file_), loader_.catalog(), problems);
  file_.reset();
  if (scenario) {
    for (const RealSideType* real : loader_.catalog().all<RealSideType>())
      real->check(*scenario, loader_.catalog(), problems);
  }
  if (strict_) core::refuse_ignored(problems);
  print_problems(problems);
  if (core::has_errors(problems)) return std::nullopt;
  return scenario;
}

std::unique_ptr<KindsOfFile> kinds_of_file(hal::PluginLoader& loader, const std::string& path) {
  core::Problems problems;
  auto file = core::open_experiment(path, {}, problems);
  auto found = std::make_unique<KindsOfFile>();
  if (file) {
    loader.look_beside(path);
    for (const core::PluginConfig& plugin : core::plugins_of(file->root)) {
      const hal::Status opened = loader.open(plugin.library);
      if (!opened.ok()) file->problems.push_back({path, plugin.line, "<plugins>: " + opened.error().message});
    }
    problems = std::move(file->problems);
    found->kinds = core::read_kinds(file->root, loader.catalog(), problems);
  }
  print_problems(problems);
  if (core::has_errors(problems)) return nullptr;
  found->catalog = core::with_kinds(loader.catalog(), found->kinds);
  return found;
}

std::unique_ptr<KindsOfFile> kinds_of_settings(const std::string& text, const std::string& name) {
  core::Problems problems;
  auto file = core::open_experiment_text(text, name, {}, problems);
  auto found = std::make_unique<KindsOfFile>();
  if (file) found->kinds = core::read_kinds(file->root, catalog(), problems);
  if (core::has_errors(problems)) found->kinds.clear();
  found->catalog = core::with_kinds(catalog(), found->kinds);
  return found;
}

std::optional<core::Scenario> read_or_complain(hal::PluginLoader& loader, const std::vector<std::string>& plugins,
                                               const std::string& path, const std::vector<std::string>& overrides,
                                               bool strict) {
  ExperimentReading reading(loader, plugins, strict);
  return reading.open(path, overrides) ? reading.read() : std::nullopt;
}

std::optional<core::Scenario> settings_or_complain(hal::PluginLoader& loader, const std::vector<std::string>& plugins,
                                                   const std::string& text, const std::string& name,
                                                   const std::vector<std::string>& overrides) {
  ExperimentReading reading(loader, plugins);
  return reading.open_text(text, name, overrides) ? reading.read() : std::nullopt;
}

}  // namespace tandem::app
