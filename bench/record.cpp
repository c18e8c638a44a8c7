#include "bench/record.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <cstdlib>
#include <filesystem>
#include <unistd.h>
#include <vector>

#include "app/experiment/reading.hpp"
#include "app/outputs/report.hpp"
#include "app/process/measure.hpp"
#include "bench/scene.hpp"
#include "core/record/record.hpp"
#include "core/sim/world.hpp"
#include "hal/median.hpp"

namespace tandem::bench {
namespace {

constexpr std::int64_t kTicksInTurn = 10;

/// Seconds of one turn: by the clock, of the thread that steps, of the whole process.
using Cost = std::array<double, 3>;

Cost now() {
  return {app::wall_seconds(), app::seconds_of(CLOCK_THREAD_CPUTIME_ID), app::cpu_seconds()};
}

/// A record that is removed when it goes.
struct TemporaryRecord {
  TemporaryRecord() {
    std::error_code error;
    auto folder = std::filesystem::temp_directory_path(error);
    path = ((error ? std::filesystem::path("/tmp") : folder) / ("tandem_bench_" + std::to_string(getpid()) + ".record"))
               .string();
  }
  ~TemporaryRecord() {
    std::error_code error;
    for (const std::string& file : {path, path + ".part"}) std::filesystem::remove(file, error);
  }
  std::string path;
};

}  // namespace

hal::Result<std::string> bench_record(const BenchCase& c, hal::PluginLoader& loader, const std::atomic<bool>& stop) {
  core::Problems problems;
  const core::Scenario scenario = scene_of(c);
  auto world = core::World::make(scenario, loader, {}, problems);
  app::print_problems(problems);
  if (world == nullptr) return hal::Error{"the scene cannot be made"};
  const TemporaryRecord file;
  core::RecordConfig config;
  config.path = file.path;
  auto opened = core::Recorder::open(config, world->space(), {{"program", "tandem bench record"}});
  if (!opened.ok()) return opened.error();
  core::Recorder& recorder = *opened.value();

  world->start();
  std::array<std::vector<Cost>, 2> turns;  // without, with
  std::int64_t recorded = 0;
  std::uint64_t bytes = 0;
  const std::int64_t pairs = std::max<std::int64_t>(1, c.ticks / (2 * kTicksInTurn));
  for (std::int64_t turn = -2; turn < 2 * pairs; ++turn) {
    if (stop.load(std::memory_order_relaxed)) return std::string();
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
  bytes = std::filesystem::file_size(file.path, error);

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
  return hal::to_text(json);
}

}  // namespace tandem::bench
