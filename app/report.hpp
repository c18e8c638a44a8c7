// What a run reports: JSON for programs, a short table for people.
#pragma once
#include <cstdint>
#include <string>
#include <vector>

#include "app/json.hpp"
#include "core/sim/world.hpp"
#include "hal/result.hpp"

namespace tandem::app {

/// Figures of one run. Times are of the main loop alone; what came before is `init_s`.
struct RunFigures {
  std::int64_t steps = 0;
  double wall_s = 0.0;
  double cpu_s = 0.0;
  double init_s = 0.0;
  std::uint64_t deadline_misses = 0;
  std::int64_t threads = 1;

  double virtual_s(std::int64_t ticks_per_second) const {
    return static_cast<double>(steps) / static_cast<double>(ticks_per_second);
  }
  double ns_per_robot_step(std::size_t robots) const {
    return steps > 0 && robots > 0 ? cpu_s * 1e9 / static_cast<double>(steps) / static_cast<double>(robots) : 0.0;
  }
};

/// The keys that every report has, into an object that is open.
void add_run_fields(Json& json, const core::World& world, const RunFigures& figures, std::size_t robots);

/// "0x" and 16 digits.
std::string hash_text(std::uint64_t hash);

/// Writes `text` to a file, or to standard output for "-".
hal::Status write_report(const std::string& path, const std::string& text);

/// Two columns, aligned.
void print_table(const std::vector<std::pair<std::string, std::string>>& rows);

}  // namespace tandem::app
