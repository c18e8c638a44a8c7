#include "app/outputs/run_figures.hpp"

#include "app/outputs/report.hpp"
#include "app/process/measure.hpp"

namespace tandem::app {

void add_run_fields(hal::Json& json, const core::World& world, const RunFigures& figures, std::size_t robots,
                    bool between_ticks) {
  const double virtual_s = figures.virtual_s(world.ticks_per_second());
  json["experiment"] = world.scenario().name;
  json["seed"] = world.seed();
  json["threads"] = figures.threads;
  json["robots"] = static_cast<std::uint64_t>(robots);
  json["steps"] = figures.steps;
  json["virtual_s"] = virtual_s;
  json["wall_s"] = figures.wall_s;
  json["cpu_s"] = figures.cpu_s;
  json["init_s"] = figures.init_s;
  json["ns_per_robot_step"] = figures.ns_per_robot_step(robots);
  json["realtime_factor"] = figures.wall_s > 0.0 ? virtual_s / figures.wall_s : 0.0;
  json["peak_rss_mb"] = peak_rss_mb();
  json["deadline_misses"] = figures.deadline_misses;
  if (between_ticks) json["state_hash"] = hash_text(world.state_hash());
}

}  // namespace tandem::app
