#include "bench/sweep.hpp"

#include <cstdlib>
#include <filesystem>
#include <fmt/format.h>
#include <sys/resource.h>
#include <thread>

#include "app/build_info.hpp"
#include "app/process/measure.hpp"
#include "app/process/signals.hpp"
#include "bench/scene.hpp"
#include "hal/json/json.hpp"
#include "study/sweep/sweep.hpp"
#include "study/table/table.hpp"

namespace tandem::bench {
namespace {

namespace fs = std::filesystem;

double seconds_of(const timeval& t) {
  return static_cast<double>(t.tv_sec) + 1e-6 * static_cast<double>(t.tv_usec);
}

/// Of this process and of its children that have ended.
double all_cpu_s() {
  double sum_s = 0.0;
  for (const int who : {RUSAGE_SELF, RUSAGE_CHILDREN}) {
    rusage usage{};
    getrusage(who, &usage);
    sum_s += seconds_of(usage.ru_utime) + seconds_of(usage.ru_stime);
  }
  return sum_s;
}

/// A folder of its own, removed at the end.
class TemporaryFolder {
 public:
  TemporaryFolder() {
    std::string pattern = (fs::temp_directory_path() / "tandem_sweep_XXXXXX").string();
    if (mkdtemp(pattern.data()) != nullptr) path_ = pattern;
  }
  ~TemporaryFolder() {
    std::error_code ignored;
    if (!path_.empty()) fs::remove_all(path_, ignored);
  }
  TemporaryFolder(const TemporaryFolder&) = delete;
  TemporaryFolder& operator=(const TemporaryFolder&) = delete;
  const fs::path& path() const { return path_; }

 private:
  fs::path path_;
};

}  // namespace

hal::Status bench_sweep(const SweepCase& c, hal::PluginLoader& loader) {
  study::Study study;
  study.experiments = {{"diffusion", "", 0}};
  for (std::int64_t i = 0; i < c.runs; ++i) study.seeds.push_back(static_cast<std::uint64_t>(i + 1));
  auto design = study::Design::of(study);
  if (!design.ok()) return design.error();
  BenchCase scene{"diffusion", "e-puck", "kinematics2d", "auto", "auto", "", "equal", c.robots, 0};
  scene.ticks = c.ticks;
  const core::Scenario scenario = [&] {
    core::Scenario made = scene_of(scene);
    made.length_s = static_cast<double>(c.ticks) / static_cast<double>(made.ticks_per_second);
    return made;
  }();
  const TemporaryFolder folder;
  const std::string path = folder.path() / "table.sqlite";
  auto table = study::Table::open(path);
  if (!table.ok()) return table.error();
  if (const hal::Status begun = (*table)->begin({"", "", {}, c.runs}); !begun.ok()) return begun;

  const std::atomic<bool>& stop = app::catch_signals();
  study::SweepOptions how;
  how.workers = std::max(1U, std::thread::hardware_concurrency());
  how.in_worker = [&] { (*table)->leave_to_parent(); };
  std::vector<std::int64_t> runs(static_cast<std::size_t>(c.runs));
  for (std::size_t i = 0; i < runs.size(); ++i) runs[i] = static_cast<std::int64_t>(i);
  std::int64_t failed = 0;
  std::uint64_t hash = 0;
  double own_cpu_s = 0.0;
  const auto take = [&](std::span<const study::FinishedRun> finished) {
    std::vector<study::RunRow> rows;
    for (const study::FinishedRun& run : finished) {
      rows.push_back({run.plan.number, "diffusion", run.plan.seed, {}, 1, 0.1, run.outcome});
      own_cpu_s += run.outcome.cpu_s;
      hash += run.outcome.fingerprint;  // of all runs, in any order
      if (!run.outcome.done) ++failed;
    }
    return (*table)->add(rows);
  };
  const double wall_s = app::wall_seconds(), cpu_s = all_cpu_s();
  hal::Status swept = study::sweep(
      *design, runs, [&](const study::RunPlan&) { return hal::Result<core::Scenario>(scenario); }, loader, how, take,
      [] {}, stop);
  if (swept.ok()) swept = (*table)->finish();
  if (!swept.ok()) return swept;
  if (failed > 0) return hal::Error{fmt::format("{} runs failed", failed)};
  if (stop.load()) return {};
  const double took_s = app::wall_seconds() - wall_s, spent_s = all_cpu_s() - cpu_s;
  hal::Json json;
  json["bench"] = "sweep";
  json["runs"] = c.runs;
  json["robots"] = c.robots;
  json["ticks"] = c.ticks;
  json["workers"] = how.workers;
  json["wall_s"] = took_s;
  json["runs_a_second"] = static_cast<double>(c.runs) / took_s;
  json["cpu_of_runs_s"] = own_cpu_s;
  json["cpu_of_all_s"] = spent_s;
  json["overhead_percent"] = 100.0 * (spent_s / own_cpu_s - 1.0);
  json["state_hash"] = fmt::format("{:#018x}", hash);
  json["cpu_model"] = app::build_info().processor;
  fmt::print("{}\n", hal::to_text(json));
  return {};
}

}  // namespace tandem::bench
