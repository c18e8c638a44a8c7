// How much more a sweep costs than its runs.
#pragma once
#include <cstdint>

#include "hal/plugin_loader.hpp"
#include "hal/result.hpp"

namespace tandem::bench {

struct SweepCase {
  std::int64_t robots = 100, ticks = 600, runs = 10'000;
};

/// Sweeps runs of the standard scene with as many seeds on all cores, into a table in a temporary folder, and prints a
/// JSON line: the processor time that the runs say they took, that of all processes together, and how many per cent
/// that is more. Error: a run failed, or the table cannot be written.
hal::Status bench_sweep(const SweepCase& c, hal::PluginLoader& loader);

}  // namespace tandem::bench
