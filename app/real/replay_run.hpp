// A replay of a record of a run with real robots: its parts, its judgement, its report.
#pragma once
#include <memory>
#include <optional>
#include <string>
#include <utility>
#include <vector>

#include "app/experiment/plugins.hpp"
#include "app/outputs/run_report.hpp"
#include "app/run_options.hpp"
#include "core/live/repeat.hpp"
#include "core/sim/world.hpp"
#include "hal/json/json.hpp"
#include "hal/log.hpp"
#include "hal/plugin_loader.hpp"
#include "hal/result.hpp"
#include "mixed_reality/replay/replay.hpp"

namespace tandem::app {

class ReplayRun {
 public:
  /// Of a run that is no replay `asked.record` is empty, and no other call follows.
  explicit ReplayRun(const RunOptions& options) : options_(options), asked_(options.replay) {}
  bool wanted() const noexcept { return !asked_.record.empty(); }

  /// Reads the beginning of the record and the experiment in it. False: complained.
  bool open(ExperimentReading& reading);
  /// Makes an experiment without real robots of the one in the record; nothing is written but what the command line
  /// names. What is to change holds from the start, or is made ready for `next_tick`. Errors, complained: there is no
  /// such robot or configuration, or no world with these settings.
  bool prepare(core::Scenario& scenario, hal::PluginLoader& loader);
  /// Whether what was asked for differs from the record from the first tick on.
  bool changed_from_start() const noexcept { return changed() && !changes_later(); }
  /// Whether plug-ins and files are those of the run. Error: names all that are not.
  hal::Status check_files(const InputFiles& now) const;
  /// Lets the recorded robots take part. Errors: as mixed_reality::Replay; what is to change cannot while a run goes
  /// on.
  hal::Status join(core::World& world, const hal::Log& log);
  std::int64_t steps() const;
  /// What a record of the replay is to hold; null: nothing, because robots are simulated.
  const core::SpaceInputs* inputs() const noexcept;

  /// Whether settings change between two ticks.
  bool changes_on_the_way() const noexcept { return changed_.has_value(); }
  /// After every tick: compares it with the record. False: it is not as it was, and was not meant to differ; told.
  bool tick_done(const core::Repeatable& recorded, const core::World& world);
  /// Between two ticks: where the robots are simulated from the next on, what is to change does. A failure is the
  /// world's. @returns what has changed now, for people; empty: nothing.
  std::string next_tick(core::World& world);
  /// After the last tick: says what ended the inputs. @returns whether all was there that was asked for.
  bool finish(const core::World& world);
  hal::Json json() const;
  std::vector<std::pair<std::string, std::string>> rows() const;

 private:
  bool changed() const noexcept { return !options_.overrides.empty() || !asked_.controllers.empty(); }
  bool changes_later() const noexcept { return changed() && asked_.from.value_or(0) > 0; }
  std::string changes() const;
  hal::Status check_record_path() const;
  void leave_robots_out(core::Scenario& scenario) const;

  const RunOptions& options_;
  const ReplayRequest& asked_;
  hal::Json start_;
  std::string settings_, name_;            ///< of the record
  std::optional<core::Scenario> changed_;  ///< to go on with
  std::unique_ptr<mixed_reality::Replay> replay_;
  std::int64_t ticks_per_second_ = 10;
  std::int64_t compared_ = 0;
  std::optional<hal::Tick> first_difference_;
  std::string difference_;
};

}  // namespace tandem::app
