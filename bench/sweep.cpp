// How much more a sweep costs than its runs.
#include "study/sweep/sweep.hpp"

#include <fmt/format.h>
#include <sys/resource.h>
#include <thread>

#include "app/build_info.hpp"
#include "app/exit_code.hpp"
#include "app/outputs/report.hpp"
#include "app/process/measure.hpp"
#include "bench/bench.hpp"
#include "hal/temporary_folder.hpp"
#include "study/table/table.hpp"

namespace tandem::bench {
namespace {

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

/// Sweeps `runs` of the standard scene with as many seeds on all cores, into a table: the processor time that the runs
/// say they took, that of all processes together, and how many per cent that is more.
hal::Status measure(BenchCase scene, std::int64_t count, const Call& call) {
  study::Study study;
  study.experiments = {{"diffusion", "", 0}};
  for (std::int64_t i = 0; i < count; ++i) study.seeds.push_back(static_cast<std::uint64_t>(i + 1));
  auto design = study::Design::of(study);
  if (!design.ok()) return design.error();
  core::Scenario scenario = scene_of(scene);
  scenario.length_s = static_cast<double>(scene.ticks) / static_cast<double>(scenario.ticks_per_second);
  const hal::TemporaryFolder folder("tandem_sweep");
  auto table = study::Table::open(folder.file("table.sqlite"));
  if (!table.ok()) return table.error();
  if (const hal::Status begun = (*table)->begin({"", "", {}, count}); !begun.ok()) return begun;

  study::SweepOptions how;
  how.workers = std::max(1U, std::thread::hardware_concurrency());
  how.in_worker = [&] { (*table)->leave_to_parent(); };
  std::vector<std::int64_t> runs(static_cast<std::size_t>(count));
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
      *design, runs, [&](const study::RunPlan&) { return hal::Result<core::Scenario>(scenario); }, call.loader, how,
      take, [] {}, call.stop);
  if (swept.ok()) swept = (*table)->finish();
  if (!swept.ok()) return swept;
  if (failed > 0) return hal::Error{fmt::format("{} runs failed", failed)};
  if (call.stop.load()) return {};
  const double took_s = app::wall_seconds() - wall_s, spent_s = all_cpu_s() - cpu_s;
  print_line({{"bench", "sweep"},
              {"runs", count},
              {"robots", scene.robots},
              {"ticks", scene.ticks},
              {"workers", how.workers},
              {"wall_s", took_s},
              {"runs_a_second", static_cast<double>(count) / took_s},
              {"cpu_of_runs_s", own_cpu_s},
              {"cpu_of_all_s", spent_s},
              {"overhead_percent", 100.0 * (spent_s / own_cpu_s - 1.0)},
              {"state_hash", app::hash_text(hash)},
              {"cpu_model", app::build_info().processor}});
  return {};
}

}  // namespace

hal::Result<int> bench_sweep(const Call& call) {
  for (const std::int64_t robots : call.options.robots_or({100})) {
    const hal::Status done =
        measure({.robots = robots, .ticks = call.options.ticks}, call.options.repeat_or(10'000), call);
    if (!done.ok()) return done.error();
  }
  return app::kDone;
}

}  // namespace tandem::bench
