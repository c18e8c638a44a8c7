// One run of a study as its table keeps it.
#pragma once
#include <cstdint>
#include <string>
#include <utility>
#include <vector>

namespace tandem::study {

/// How a run went on, and what was measured.
struct RunOutcome {
  bool done = false;    ///< it came to its end, and no controller threw
  std::string ended;    ///< "length", "hook"; "failed"
  std::string failure;  ///< what, who, which tick; empty when it is done
  std::int64_t ticks = 0;
  double virtual_s = 0.0;
  std::uint64_t fingerprint = 0;                         ///< of the state at the end
  std::vector<std::pair<std::string, double>> measures;  ///< at the end, by name
  std::vector<std::int64_t> sample_ticks;                ///< numbers of ticks that were done
  /// By name, one value for each of `sample_ticks`; NaN: not measured yet.
  std::vector<std::pair<std::string, std::vector<double>>> samples;
  double wall_s = 0.0, cpu_s = 0.0;  ///< from the placing of the robots to the end
};

struct RunRow {
  std::int64_t run = 0;
  std::string experiment;
  std::uint64_t seed = 0;
  std::vector<std::string> settings;  ///< as the head names them
  std::int64_t version = 0;           ///< of program and files
  double tick_s = 0.1;
  RunOutcome outcome;
};

}  // namespace tandem::study
