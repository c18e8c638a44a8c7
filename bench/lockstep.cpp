// What a run in lock-step costs: a hub here, its peers in processes of their own.
#include <cmath>
#include <fmt/format.h>
#include <sys/resource.h>

#include "app/build_info.hpp"
#include "app/exit_code.hpp"
#include "app/outputs/report.hpp"
#include "app/process/measure.hpp"
#include "app/real/lockstep_peers.hpp"
#include "bench/bench.hpp"
#include "core/config/reader.hpp"
#include "hal/output_file.hpp"
#include "hal/program.hpp"
#include "hal/temporary_folder.hpp"

namespace tandem::bench {
namespace {

/// Error: the run failed, or has another fingerprint than the simulation.
hal::Status measure(std::int64_t peers, const Call& call) {
  const hal::TemporaryFolder folder("tandem_lockstep");
  const std::string file = folder.file("lockstep.xml");
  const double side_m = std::sqrt(0.1 * static_cast<double>(peers)) + 0.6;
  const std::string text = fmt::format(fmt::runtime(hal::carried_text(scene_files(), "lockstep.xml")), side_m,
                                       0.5 * side_m - 0.15, 0.5 * side_m - 0.05, peers);
  if (const hal::Status written = hal::write_whole_file(file, "experiment", text); !written.ok()) return written;
  core::Problems problems;
  const auto scenario = core::read_experiment(file, {}, call.loader.catalog(), problems);
  if (!scenario) return hal::Error{problems.empty() ? "the scene cannot be read" : hal::to_text(problems.front())};
  const auto pure = world_of(*scenario, call.loader), world = world_of(*scenario, call.loader);
  if (pure == nullptr || world == nullptr) return hal::Error{"the scene cannot be made"};
  mixed_reality::LockstepOptions options;
  options.stop = &call.stop;
  auto made = mixed_reality::LockstepRun::make(*world, options);
  if (!made.ok()) return made.error();
  const auto run = std::move(made).value();
  std::vector<std::unique_ptr<hal::Program>> programs;  // ended with this
  for (std::int64_t i = 0; i < peers; ++i) {
    auto started = hal::Program::start(
        "/proc/self/exe", {"robot", file, "--robot", fmt::format("ep{}", i), "--link", "peer:" + run->address()});
    if (!started.ok()) return started.error();
    programs.push_back(std::move(started).value());
  }
  if (const hal::Status connected = run->connect(); !connected.ok()) return connected;
  const std::int64_t ticks = call.options.ticks;
  world->start();
  const double began_s = app::wall_seconds();
  for (std::int64_t i = 0; i < ticks && world->step() && world->state() == core::RunState::Running; ++i) continue;
  const double wall_s = app::wall_seconds() - began_s;
  run->finish(false, "the run is over");
  if (world->tick() != ticks)
    return hal::Error{world->failure().empty() ? std::string("interrupted") : world->failure()};
  pure->start();
  for (std::int64_t i = 0; i < ticks; ++i) pure->step();
  if (pure->state_hash() != world->state_hash())
    return hal::Error{"the fingerprint is not that of the simulation: a run whose hash is wrong is none"};
  const double virtual_s = static_cast<double>(ticks) / static_cast<double>(scenario->ticks_per_second);
  print_line({{"bench", "lockstep"},
              {"peers", peers},
              {"ticks", ticks},
              {"wall_s", wall_s},
              {"us_per_tick", 1e6 * wall_s / static_cast<double>(ticks)},
              {"times_real_time", virtual_s / wall_s},
              {"state_hash", app::hash_text(world->state_hash())},
              {"cpu_model", app::build_info().processor}});
  return {};
}

}  // namespace

hal::Result<int> bench_lockstep(const Call& call) {
  rlimit files{};  // three for each peer
  if (getrlimit(RLIMIT_NOFILE, &files) == 0) files.rlim_cur = files.rlim_max;
  (void)setrlimit(RLIMIT_NOFILE, &files);
  for (const std::int64_t peers : call.options.robots_or({20})) {
    if (peers > 1000) return refuse(app::kWrongUsage, "at most 1000 peers, each a process");
    for (std::int64_t i = 0; i < call.options.repeat; ++i) {
      if (const hal::Status done = measure(peers, call); !done.ok()) return done.error();
    }
  }
  return app::kDone;
}

}  // namespace tandem::bench
