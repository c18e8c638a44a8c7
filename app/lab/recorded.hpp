// A record of a run with the experiment that it is of.
#pragma once
#include <memory>
#include <optional>
#include <string>
#include <vector>

#include "core/scenario/scenario.hpp"
#include "hal/plugin_loader.hpp"
#include "hal/result.hpp"
#include "mixed_reality/gap/recorded_run.hpp"

namespace tandem::app {

struct Recorded {
  mixed_reality::RecordedRun run;
  std::unique_ptr<hal::PluginLoader> loader;  ///< outlives the scenario
  core::Scenario scenario;                    ///< of the record's settings

  /// Of a robot; null: unknown.
  const hal::RobotKind* kind_of(const mixed_reality::RecordedRobot& robot) const {
    return core::find_kind(scenario, loader->catalog(), robot.kind);
  }
};

/// `overrides` change its settings. Nothing: complained.
std::optional<Recorded> open_recorded(const std::string& path, const std::vector<std::string>& plugins,
                                      const std::vector<std::string>& overrides = {});

/// A file in its place is kept as FILE.bak.
hal::Status write_text(const std::string& path, const std::string& what, const std::string& text);

/// Whether the commands of the gap mean a robot: one of these ids or patterns with '*'; without any, a real one, or
/// each where none is real.
bool is_meant(const mixed_reality::RecordedRobot& robot, const mixed_reality::RecordedRun& run,
              const std::vector<std::string>& patterns);

}  // namespace tandem::app
