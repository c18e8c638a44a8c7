// The window as a part of a run.
#pragma once
#include <memory>

#include "core/run/run.hpp"
#include "hal/result.hpp"

namespace tandem::app {

struct RunPlan;
struct ViewRequest;
struct ViewedSpace;

/// Opens it. @returns the program's code; errors were reported.
int add_view(RunPlan& plan, core::Run& run);

/// As RunModule::view.
hal::Result<std::unique_ptr<core::RunPart>> view_space(const ViewRequest& request, const ViewedSpace& shown);

}  // namespace tandem::app
