#include "app/report.hpp"

#include <algorithm>
#include <cstdio>
#include <fmt/format.h>
#include <fstream>

#include "app/measure.hpp"

namespace tandem::app {

std::string hash_text(std::uint64_t hash) {
  return fmt::format("0x{:016x}", hash);
}

void add_run_fields(Json& json, const core::World& world, const RunFigures& figures, std::size_t robots) {
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
      .field("state_hash", hash_text(world.state_hash()))
      .field("deadline_misses", figures.deadline_misses);
}

hal::Status write_report(const std::string& path, const std::string& text) {
  if (path == "-") {
    std::fwrite(text.data(), 1, text.size(), stdout);
    std::fputc('\n', stdout);
    std::fflush(stdout);
    return {};
  }
  std::ofstream out(path);
  out << text << "\n";
  out.close();
  if (!out) return hal::Error{"the report '" + path + "' cannot be written; check the folder and its permissions"};
  return {};
}

void print_table(const std::vector<std::pair<std::string, std::string>>& rows) {
  std::size_t width = 0;
  for (const auto& [name, value] : rows) width = std::max(width, name.size());
  for (const auto& [name, value] : rows) fmt::print("  {:<{}}  {}\n", name, width, value);
}

}  // namespace tandem::app
