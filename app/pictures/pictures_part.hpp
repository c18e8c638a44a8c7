// Pictures, films and scenes of a run.
#pragma once
#include <vector>

#include "app/outputs/report.hpp"
#include "core/run/run.hpp"
#include "hal/result.hpp"

namespace tandem::app {

struct RunOptions;
struct RunPlan;

/// Error: they cannot be made here.
hal::Result<std::vector<NamedFile>> picture_files(const RunOptions& options);
/// Opens them, and the layers over them. @returns the program's code; errors were reported.
int open_pictures(RunPlan& plan);
/// Draws; says how the run is drawn now.
int add_pictures(RunPlan& plan, core::Run& run);

}  // namespace tandem::app
