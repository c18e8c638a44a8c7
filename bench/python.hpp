// How fast Python drives worlds.
#pragma once
#include <cstdint>
#include <vector>

#include "hal/result.hpp"

namespace tandem::bench {

struct PythonCase {
  std::vector<std::int64_t> robots;
  std::int64_t ticks = 600, runs = 600;
};

/// Becomes the machine's Python with `tandem.bench`, which prints a JSON line for each number of robots and one for
/// whole runs. Returns only where there is no Python to become.
hal::Status bench_python(const PythonCase& c);

}  // namespace tandem::bench
