// The parts that a run of the command line is made of. Each is made by a function of its own, in the order in which
// they stand here, from what was made before; their turns in a tick are another order (core/run/run.hpp).
#pragma once
#include "app/run/run_plan.hpp"
#include "core/run/run.hpp"

namespace tandem::app {

/// Adds a part to `run` where the plan wants it, and makes itself known there. @returns kDone, or what was wrong, which
/// was told. Plan and run must outlive the parts.
using AddPart = int (*)(RunPlan& plan, core::Run& run);

/// Connects the real robots; waits until all are there.
int add_real_robots(RunPlan& plan, core::Run& run);
/// Waits for the peers of a run in lock-step.
int add_lockstep(RunPlan& plan, core::Run& run);
/// Before the first tick: goes on from a checkpoint.
int add_resumption(RunPlan& plan, core::Run& run);
/// People who pause, go back and touch; without them the run has its length, and its file's pace.
int add_hold(RunPlan& plan, core::Run& run);
/// Progress, or a table on the terminal.
int add_terminal(RunPlan& plan, core::Run& run);
/// Records, observers, pictures, the dump; at the end the results.
int add_outputs(RunPlan& plan, core::Run& run);
/// Keeps the state of the run in a file.
int add_checkpoints(RunPlan& plan, core::Run& run);
/// Compares with the record that is replayed or repeated.
int add_comparison(RunPlan& plan, core::Run& run);
/// Commands to real robots.
int add_desk(RunPlan& plan, core::Run& run);
/// The window, and the files of scripts that are read anew.
int add_view(RunPlan& plan, core::Run& run);

/// What the experiment's <run> names: parts of plug-ins.
int add_named_parts(RunPlan& plan, core::Run& run);

}  // namespace tandem::app
