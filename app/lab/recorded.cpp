#include "app/lab/recorded.hpp"

#include <algorithm>

#include "app/catalog.hpp"
#include "app/exit_code.hpp"
#include "app/experiment/plugin_folders.hpp"
#include "app/experiment/plugins.hpp"
#include "app/outputs/report.hpp"
#include "app/process/terminal.hpp"
#include "core/record/pattern.hpp"
#include "hal/output_file.hpp"
#include "hal/plugin_loader.hpp"

namespace tandem::app {

std::optional<Recorded> open_recorded(const std::string& path, const std::vector<std::string>& plugins,
                                      const std::vector<std::string>& overrides) {
  auto run = mixed_reality::read_recorded_run(path);
  if (!run.ok()) {
    complain(kBadInput, run.error().message);
    return std::nullopt;
  }
  for (const std::string& line : run.value().damage) say("record '" + path + "': " + line);
  Recorded recorded{std::move(run).value(), std::make_unique<hal::PluginLoader>(plugin_folders(), catalog()), {}};
  const auto settings = recorded.run.start.find("settings");
  if (settings == recorded.run.start.end() || !settings->is_string()) {
    complain(kBadInput, "record '" + path + "' has no settings: it does not say what its robots are");
    return std::nullopt;
  }
  auto scenario = settings_or_complain(*recorded.loader, plugins, settings->get<std::string>(), path, overrides);
  if (!scenario) return std::nullopt;
  recorded.scenario = std::move(*scenario);
  return recorded;
}

hal::Status write_text(const std::string& path, const std::string& what, const std::string& text) {
  if (hal::Status kept = keep_old(path); !kept.ok()) return kept;
  auto file = hal::OutputFile::open(path, what);
  if (!file.ok()) return file.error();
  if (const hal::Status written = file.value().write(text); !written.ok()) return written;
  return file.value().commit();
}

bool is_meant(const mixed_reality::RecordedRobot& robot, const mixed_reality::RecordedRun& run,
              const std::vector<std::string>& patterns) {
  if (patterns.empty())
    return robot.real || std::none_of(run.robots.begin(), run.robots.end(), [](const auto& r) { return r.real; });
  return std::any_of(patterns.begin(), patterns.end(),
                     [&](const std::string& pattern) { return core::fits_pattern(robot.id, pattern); });
}

}  // namespace tandem::app
