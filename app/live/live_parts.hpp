// Parts of runs that people hold, watch, or have repeated.
#pragma once
#include "app/run/run_plan.hpp"
#include "core/run/run.hpp"

namespace tandem::app {

/// What is to be done again; nothing where no record was named. @returns the program's code; errors were reported.
int read_repeated(RunPlan& plan);
/// The repeated run begins with the scripts of the record, whatever stands in their files now.
void run_recorded_scripts(RunPlan& plan);

/// People who pause the run, go back in it and touch it; runs with real robots have no way back.
void hold(RunPlan& plan, core::Run& run);
/// A table of it on the terminal.
void watch(RunPlan& plan, core::Run& run);
/// Compares every tick with the record of the run that is repeated.
void compare_repeated(RunPlan& plan, core::Run& run);

}  // namespace tandem::app
