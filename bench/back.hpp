// How long the way back to an earlier tick takes, and what the checkpoints for it cost.
#pragma once
#include <cstdint>
#include <string>

#include "bench/bench_case.hpp"
#include "hal/plugin_loader.hpp"

namespace tandem::bench {

/// Steps the scene without checkpoints and with them, `rounds` times in turns, and then goes to ticks all over the run.
/// Prints one JSON object. @returns the program's exit code
int bench_back(const BenchCase& c, std::int64_t rounds, hal::PluginLoader& loader);

}  // namespace tandem::bench
