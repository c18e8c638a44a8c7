#include "app/run_figures.hpp"

#include "app/measure.hpp"
#include "app/report.hpp"

namespace tandem::app {

void add_run_fields(Json& json, const core::World& world, const RunFigures& figures, std::size_t robots,
                    bool between_ticks) {
  const double virtual_s = figures.virtual_s(world.ticks_per_second());
  json.field("experiment", world.scenario().name)
      .field("seed", world.seed())
      .field("threads", figures.threads)
      .field("robots", static_cast<std::uint64_t>(robots))
      .field("steps", figures.steps)
      .field("virtual_s", virtual_s)
      .field("wall_s", figures.wall_s)
      .field("cpu_s", figures.cpu_s)
      .field("init_s", figures.init_s)
      .field("ns_per_robot_step", figures.ns_per_robot_step(robots))
      .field("realtime_factor", figures.wall_s > 0.0 ? virtual_s / figures.wall_s : 0.0)
      .field("peak_rss_mb", peak_rss_mb())
      .field("deadline_misses", figures.deadline_misses);
  if (between_ticks) json.field("state_hash", hash_text(world.state_hash()));
}

}  // namespace tandem::app
