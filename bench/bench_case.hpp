// One run of a benchmark: everything that tells it from the others.
#pragma once
#include <cstdint>
#include <string>
#include <vector>

#include "core/scenario/scenario.hpp"

namespace tandem::bench {

struct BenchCase {
  std::string bench;  ///< "diffusion" or "flocking"
  std::string robot;
  std::string engine;
  std::string partition;  ///< A1 to A16; another split of the arena as it was asked for
  std::string regions;    ///< "4x4" or "auto"
  std::string devices;    ///< that the robots have besides proximity sensors and wheels: names with commas between
  std::string density;    ///< "40 m": always that arena; "equal": it grows with the robots
  std::int64_t robots = 1;
  std::int64_t threads = 0;
  core::Assignment assignment = core::Assignment::Static;
  std::int64_t ticks = 600;
  std::int64_t repeat = 0;                   ///< how many runs of the same kind were before
  std::string script = {};                   ///< of "lua": the file
  std::vector<core::KindConfig> kinds = {};  ///< of a file, one of which `robot` may be
};

/// "static" or "dynamic", as the command line and the results spell it.
inline std::string assignment_word(core::Assignment a) {
  return a == core::Assignment::Static ? "static" : "dynamic";
}

}  // namespace tandem::bench
