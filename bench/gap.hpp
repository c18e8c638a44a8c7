// `bench gap`: how well hidden parameters of emulated robots are found, and how well pseudo-realities drawn from them
// rank controllers.
#pragma once
#include <atomic>
#include <cstdint>

#include "hal/plugin_loader.hpp"
#include "hal/result.hpp"

namespace tandem::bench {

struct GapCase {
  std::int64_t robots = 50;      ///< emulated e-pucks with hidden parameters
  double seconds = 600.0;        ///< that each drives, in virtual time
  std::int64_t realities = 200;  ///< pseudo-realities; 0: only the parameters
};

/// Prints a line of JSON for what was found, and one for the ranking. Errors: a run that cannot be made.
hal::Status bench_gap(const GapCase& c, hal::PluginLoader& loader, const std::atomic<bool>& stop);

}  // namespace tandem::bench
