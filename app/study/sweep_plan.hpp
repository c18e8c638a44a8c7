// A study on its way to its runs: experiments read and judged with every value, runs that are still to be made.
#pragma once
#include <memory>
#include <optional>
#include <string>
#include <vector>

#include "core/scenario/scenario.hpp"
#include "hal/plugin_loader.hpp"
#include "study/design.hpp"
#include "study/table/table.hpp"

namespace tandem::app {

/// The experiment of a run as `loader` knows its parts; real robots are simulated ones. Error: for people.
hal::Result<core::Scenario> scenario_of(const study::Design& design, const study::RunPlan& plan,
                                        hal::PluginLoader& loader);

/// Opens the plug-ins of all experiments, and reads each with every value of every parameter (of long lists a few
/// hundred); then makes a world of each in a process of its own. Problems are printed, with the lines of the study.
/// @returns the first scenario of every experiment; nothing when something is wrong
std::optional<std::vector<core::Scenario>> judge(const study::Design& design, hal::PluginLoader& loader,
                                                 const std::vector<std::string>& plugins);

/// Program and files that decide what the runs do.
study::Version version_of(const std::vector<core::Scenario>& experiments, const hal::PluginLoader& loader);

/// Why the table's runs are not those of this study; success: they are.
hal::Status check_same_runs(const study::Design& design, const study::TableHead& head,
                            const std::vector<study::KnownRun>& known);

/// Why runs of now would differ from those of then; success: they would not.
hal::Status check_same_version(const study::Version& then, const study::Version& now);

/// What to type to make one run alone.
std::string command_of(const study::Design& design, const study::RunPlan& plan);

}  // namespace tandem::app
