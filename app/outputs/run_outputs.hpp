// The files that a run writes: opened before it, in their places after it.
#pragma once
#include <functional>
#include <memory>
#include <optional>

#include "app/outputs/observers.hpp"
#include "app/outputs/pictures.hpp"
#include "app/outputs/state_dump.hpp"
#include "app/run_options.hpp"
#include "core/record/record.hpp"
#include "core/record/trajectory.hpp"
#include "core/sim/world.hpp"
#include "core/view/layers/layer_set.hpp"
#include "hal/catalog.hpp"
#include "hal/output_file.hpp"

namespace tandem::app {

/// Open outputs of a run; those that were not asked for are empty.
struct RunOutputs {
  std::optional<hal::OutputFile> report;
  std::optional<hal::OutputFile> picture, scene;
  std::string povray;                  ///< what the scene is for
  std::unique_ptr<Pictures> pictures;  ///< on the way
  core::PictureLook look;
  std::unique_ptr<core::LayerSet> layers;  ///< over pictures
  std::unique_ptr<core::TrajectoryRecorder> trajectory;
  std::unique_ptr<core::Recorder> record;
  std::optional<StateDump> dump;
  Observers observers;  ///< made by themselves, because what they complain of has a line
};

/// Whether the paths make sense together. Errors: one names a file that the experiment is read from, or another
/// output's; a picture or film of no known ending, or that cannot be made here.
hal::Status check_output_paths(const RunOptions& options, const core::Scenario& scenario, const hal::Catalog& catalog);

/// Whether a report or a record of the run is to name the files that decide it, with their digests.
bool tells_files(const RunOptions& options, const core::Scenario& scenario);

/// Opens all but the observers; `catalog` must outlive them, `record_start` makes what a record begins with, `steps`
/// are to be done (0: nobody knows). Error: one cannot be written, or its robots or layers are not there.
hal::Result<RunOutputs> open_outputs(const RunOptions& options, const core::Scenario& scenario,
                                     const core::World& world, const hal::Catalog& catalog,
                                     const std::function<hal::Json()>& record_start, std::int64_t steps);

}  // namespace tandem::app
