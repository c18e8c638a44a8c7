// What a record of all poses adds to a run.
#include "core/record/record.hpp"

#include <algorithm>
#include <array>
#include <filesystem>
#include <vector>

#include "app/exit_code.hpp"
#include "app/process/measure.hpp"
#include "bench/bench.hpp"
#include "hal/median.hpp"
#include "hal/temporary_folder.hpp"

namespace tandem::bench {
namespace {

constexpr std::int64_t kTicksInTurn = 10;

/// Seconds of one turn: by the clock, of the thread that steps, of the whole process.
using Cost = std::array<double, 3>;

Cost now() {
  return {app::wall_seconds(), app::seconds_of(CLOCK_THREAD_CPUTIME_ID), app::cpu_seconds()};
}

/// Steps one world, in turns for some ticks with a record and for some without, and compares neighbours; so the
/// machine's moods meet both.
hal::Status measure(const BenchCase& c, const Call& call) {
  auto world = world_of(scene_of(c), call.loader);
  if (world == nullptr) return hal::Error{"the scene cannot be made"};
  const hal::TemporaryFolder folder("tandem_bench");
  core::RecordConfig config;
  config.path = folder.file("bench.record");
  auto opened = core::Recorder::open(config, world->space(), {{"program", "tandem bench record"}});
  if (!opened.ok()) return opened.error();
  core::Recorder& recorder = *opened.value();

  world->start();
  std::array<std::vector<Cost>, 2> turns;  // without, with
  std::int64_t recorded = 0;
  const std::int64_t pairs = std::max<std::int64_t>(1, c.ticks / (2 * kTicksInTurn));
  for (std::int64_t turn = -2; turn < 2 * pairs; ++turn) {
    if (call.stop.load(std::memory_order_relaxed)) return {};
    const std::size_t with = ((turn + 4) % 4 == 1 || (turn + 4) % 4 == 2) ? 1 : 0;  // without, with, with, without
    const Cost before = now();
    for (std::int64_t i = 0; i < kTicksInTurn; ++i) {
      world->step();
      if (with == 0) continue;
      if (const hal::Status done = recorder.tick_done(world->space(), world->tick() - 1); !done.ok())
        return done.error();
      ++recorded;
    }
    Cost cost = now();
    for (std::size_t i = 0; i < cost.size(); ++i) cost[i] -= before[i];
    if (turn >= 0) turns[with].push_back(cost);  // the first two warm up
  }
  if (const hal::Status closed = recorder.close(world->tick() - 1, hal::Json::object()); !closed.ok())
    return closed.error();
  std::error_code error;
  const auto bytes = std::filesystem::file_size(config.path, error);

  hal::Json json = {{"bench", "record"},
                    {"robots", c.robots},
                    {"threads", c.threads},
                    {"ticks", 2 * pairs * kTicksInTurn},
                    {"repeat", c.repeat},
                    {"bytes_per_robot_tick",
                     static_cast<double>(bytes) / static_cast<double>(c.robots) / static_cast<double>(recorded)}};
  const std::array<const char*, 3> names = {"wall", "stepping_thread", "cpu"};
  for (std::size_t i = 0; i < names.size(); ++i) {
    std::array<std::vector<double>, 2> us;
    std::vector<double> quotients;
    for (std::size_t k = 0; k < 2; ++k) {
      for (const Cost& cost : turns[k]) us[k].push_back(1e6 * cost[i] / static_cast<double>(kTicksInTurn));
    }
    for (std::size_t pair = 0; pair < us[0].size() && pair < us[1].size(); ++pair)
      quotients.push_back(us[1][pair] / us[0][pair]);
    const std::string name = names[i];
    json[name + "_us_per_tick"] = {{"without", hal::upper_median(us[0])}, {"with", hal::upper_median(us[1])}};
    json[name + "_quotient"] = hal::upper_median(quotients);
  }
  print_line(json);
  return {};
}

}  // namespace

hal::Result<int> bench_record(const Call& call) {
  Call measured = call;
  measured.robots = call.options.robots_or({10'000});
  for (BenchCase& c : cases_of(measured)) {
    c.bench = "diffusion";
    if (const hal::Status done = measure(c, call); !done.ok()) return done.error();
    if (call.stop.load()) break;
  }
  return app::kDone;
}

}  // namespace tandem::bench
