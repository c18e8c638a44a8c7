// Cost figures of a run, for its report.
#pragma once
#include <cstddef>
#include <cstdint>
#include <optional>

#include "core/sim/world.hpp"
#include "hal/json/json.hpp"

namespace tandem::app {

/// Figures of one run. Times are of the main loop alone; what came before is `init_s`.
struct RunFigures {
  std::int64_t steps = 0;
  double wall_s = 0.0;
  double cpu_s = 0.0;
  double init_s = 0.0;
  std::uint64_t deadline_misses = 0;
  std::optional<std::uint64_t> misses_by_machine = {};  ///< of these, because it gave no processor; nothing: not known
  std::int64_t threads = 1;

  double virtual_s(std::int64_t ticks_per_second) const {
    return static_cast<double>(steps) / static_cast<double>(ticks_per_second);
  }
  double ns_per_robot_step(std::size_t robots) const {
    return steps > 0 && robots > 0 ? cpu_s * 1e9 / static_cast<double>(steps) / static_cast<double>(robots) : 0.0;
  }
};

/// The keys that every report has, into an object. Only `between_ticks` the state has a
/// hash.
void add_run_fields(hal::Json& json, const core::World& world, const RunFigures& figures, std::size_t robots,
                    bool between_ticks = true);

}  // namespace tandem::app
