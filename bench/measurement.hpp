// Runs one case of a benchmark and tells what it cost.
#pragma once
#include <atomic>
#include <string>

#include "bench/bench_case.hpp"
#include "hal/plugin_loader.hpp"

namespace tandem::bench {

struct Measurement {
  int code = 0;      ///< exit code: app::kDone also when the run was interrupted
  std::string line;  ///< one JSON object without a line break; empty when interrupted or when the world cannot be made
};

/// The world is made with the parts of `loader`. Runs in a process of its own, so that no run inherits memory from the
/// one before; its problems go to standard error. Ends early, without a line, once `stop` is set.
Measurement measure_apart(const BenchCase& c, hal::PluginLoader& loader, const std::atomic<bool>& stop);

}  // namespace tandem::bench
