// `bench record`: what a record of all poses costs a run.
#pragma once
#include <atomic>
#include <string>

#include "bench/bench_case.hpp"
#include "hal/plugin_loader.hpp"
#include "hal/result.hpp"

namespace tandem::bench {

/// Steps one world, in turns for some ticks with a record and for some without, and compares neighbours; so the
/// machine's moods meet both. @returns a line of JSON; empty when interrupted. Error: no file can be written in the
/// folder for temporary files.
hal::Result<std::string> bench_record(const BenchCase& c, hal::PluginLoader& loader, const std::atomic<bool>& stop);

}  // namespace tandem::bench
