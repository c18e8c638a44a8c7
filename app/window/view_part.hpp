// The window as a part of a run.
#pragma once
#include "core/run/run.hpp"

namespace tandem::app {

struct RunPlan;

/// Opens it. @returns the program's code; errors were reported.
int add_view(RunPlan& plan, core::Run& run);

}  // namespace tandem::app
