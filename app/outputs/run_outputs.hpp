// The files that a run writes: opened before it, in their places after it.
#pragma once
#include <functional>
#include <memory>
#include <optional>
#include <vector>

#include "app/outputs/observers.hpp"
#include "app/outputs/report.hpp"
#include "app/outputs/state_dump.hpp"
#include "app/run_options.hpp"
#include "core/record/record.hpp"
#include "core/record/trajectory.hpp"
#include "core/sim/world.hpp"
#include "hal/catalog.hpp"
#include "hal/output_file.hpp"

namespace tandem::app {

/// Open outputs of a run; those that were not asked for are empty.
struct RunOutputs {
  std::optional<hal::OutputFile> report;
  std::vector<const hal::OutputFile*> at_the_end;  ///< of parts: empty until the run is over
  std::unique_ptr<core::TrajectoryRecorder> trajectory;
  std::unique_ptr<core::Recorder> record;
  std::optional<StateDump> dump;
  Observers observers;  ///< made by themselves, because what they complain of has a line
};

/// Whether the paths make sense together, with `outputs` of parts and `inputs` of real robots. Error: one names a file
/// that the experiment is read from, or another output's.
hal::Status check_output_paths(const RunOptions& options, const core::Scenario& scenario,
                               std::vector<NamedFile> outputs, const std::vector<NamedFile>& inputs);

/// Whether a report or a record of the run is to name the files that decide it, with their digests.
bool tells_files(const RunOptions& options, const core::Scenario& scenario);

/// Opens all but the observers; `record_start` makes what a record begins with. Error: one cannot be written, or its
/// robots are not there.
hal::Result<RunOutputs> open_outputs(const RunOptions& options, const core::Scenario& scenario,
                                     const core::World& world, const std::function<hal::Json()>& record_start);

}  // namespace tandem::app
