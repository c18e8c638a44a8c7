#include "bench/bench.hpp"

#include <algorithm>
#include <cstdio>
#include <fmt/format.h>

#include "app/experiment/reading.hpp"
#include "app/process/terminal.hpp"

namespace tandem::bench {

std::vector<BenchCase> cases_of(const Call& call, const std::string& script) {
  const BenchOptions& o = call.options;
  BenchCase c{.bench = o.name, .robot = call.robot, .ticks = o.ticks, .script = script, .kinds = call.kinds};
  for (const std::string& device : o.devices) c.devices += (c.devices.empty() ? "" : ",") + device;
  c.density = o.density.empty() && o.name != "flocking" ? "40 m" : "equal";
  c.dynamic = o.assignment == "dynamic";
  std::vector<BenchCase> cases;
  for (c.repeat = 0; c.repeat < o.repeat; ++c.repeat) {
    for (const std::string& engine : call.engines) {
      c.engine = engine;
      for (const Partition& partition : call.partitions) {
        c.partition = partition;
        for (const std::int64_t robots : call.robots) {
          c.robots = robots;
          for (const std::int64_t threads : call.threads) {
            c.threads = threads;
            cases.push_back(c);
          }
        }
      }
    }
  }
  return cases;
}

std::unique_ptr<core::World> world_of(const core::Scenario& scenario, hal::PluginLoader& loader,
                                      const core::WorldOptions& options) {
  core::Problems problems;
  auto world = core::World::make(scenario, loader, options, problems);
  app::print_problems(problems);
  return world;
}

int refuse(int code, const std::string& message) {
  app::say("tandem bench: " + message);
  return code;
}

void print_line(const hal::Json& line) {
  fmt::print("{}\n", hal::to_text(line));
  std::fflush(stdout);
}

}  // namespace tandem::bench
