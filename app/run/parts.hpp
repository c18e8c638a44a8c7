// The parts that a run of the command line is made of. Each is made by a function of its own, in the order in which
// they stand here, from what was made before; their turns in a tick are another order (core/run/run.hpp).
#pragma once
#include "app/run/run_plan.hpp"
#include "core/run/run.hpp"

namespace tandem::app {

/// Adds a part to `run` where the plan wants it, and makes itself known there. @returns kDone, or what was wrong, which
/// was told. Plan and run must outlive the parts.
using AddPart = int (*)(RunPlan& plan, core::Run& run);

/// Connects the real robots, or waits for the peers of a run in lock-step.
int add_real_robots(RunPlan& plan, core::Run& run);
/// Before the first tick: goes on from a checkpoint.
int add_resumption(RunPlan& plan, core::Run& run);
/// People who pause, go back and touch; without them the run has its length, and its file's pace. Progress, or a table
/// on the terminal.
int add_hold(RunPlan& plan, core::Run& run);
/// Records, observers, the dump; at the end the results.
int add_outputs(RunPlan& plan, core::Run& run);
/// Keeps the state of the run in a file.
int add_checkpoints(RunPlan& plan, core::Run& run);
/// Commands to real robots, the comparison of a replay.
int add_desk(RunPlan& plan, core::Run& run);
/// Pictures and films, the window.
int add_views(RunPlan& plan, core::Run& run);
/// What the experiment's <run> names: parts of plug-ins.
int add_named_parts(RunPlan& plan, core::Run& run);

}  // namespace tandem::app
