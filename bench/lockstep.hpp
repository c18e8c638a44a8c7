// What a run in lock-step costs: a hub here, its peers in processes of their own.
#pragma once
#include <cstdint>

#include "hal/plugin_loader.hpp"
#include "hal/result.hpp"

namespace tandem::bench {

struct LockstepCase {
  std::int64_t peers = 20;
  std::int64_t ticks = 600;
};

/// Prints one line. Error: the run failed, or has another fingerprint than the simulation.
hal::Status bench_lockstep(const LockstepCase& c, hal::PluginLoader& loader);

}  // namespace tandem::bench
