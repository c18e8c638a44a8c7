// Makes the report and the table of a finished run.
#pragma once
#include <cstdint>
#include <string>
#include <utility>
#include <vector>

#include "app/outputs/run_figures.hpp"
#include "core/run/run.hpp"
#include "core/scenario/scenario.hpp"
#include "core/sim/world.hpp"
#include "hal/json/json.hpp"

namespace tandem::app {

/// How a run ended: its length was done, a hook or a part of a plug-in ended it, a signal interrupted it, or it failed.
enum class Ended { Length, Hook, Part, Interrupted, Failed };

/// A run that is over.
struct RunEnd {
  Ended how = Ended::Length;
  std::string failure;            ///< what, who, which tick; empty while it did not fail
  std::int64_t steps_wanted = 0;  ///< 0: endless

  /// Whether it came to the end that it was to have.
  bool finished() const noexcept { return how == Ended::Length || how == Ended::Hook || how == Ended::Part; }
};

/// Of a run that is stepped no more.
RunEnd end_of(const core::Run& run, std::int64_t steps_wanted);

/// A file that decides what a run does.
struct InputFile {
  std::string id;     ///< of the configuration; empty: none
  std::string label;  ///< registered name; empty: the file has none
  std::string file;
  std::string sha256;  ///< empty: it cannot be read
};
/// The files of a run, as they are now: to be asked before it.
struct InputFiles {
  InputFile experiment;
  std::vector<InputFile> plugins, controllers, hooks;
  std::vector<InputFile> others;  ///< images of floors, maps of robots
};
InputFiles input_files(const core::Scenario& scenario, const hal::PluginLoader& loader);

/// The files and plug-ins that are not those of a run, by what its record or checkpoint says at its start, a line each,
/// and each after a line's end. `others_named`: those of another name are intended.
std::string changed_files(const hal::Json& start, const InputFiles& now, bool others_named);

/// Input of the report and the table.
struct RunResult {
  const core::World& world;
  const InputFiles& inputs;
  RunFigures figures;
  std::size_t robots = 0;
  RunEnd end;
  hal::Json more = {};                                              ///< members of parts; null: none
  std::vector<std::pair<std::string, std::string>> more_rows = {};  ///< of the table
};

/// One JSON object.
std::string report_of(const RunResult& result);
/// Its members but those about the end, for a run that may have to be ended in the middle of a tick.
hal::Json report_members(const RunResult& result);

/// First block of a record: all that is known before the first tick.
hal::Json record_start(const core::Scenario& scenario, std::uint64_t seed, const InputFiles& inputs);
/// Last block of a record: the report.
hal::Json record_end(const RunResult& result);

void print_result(const RunResult& result);

}  // namespace tandem::app
