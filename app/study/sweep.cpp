// `tandem sweep`: makes the runs of a study, and keeps them in a table.
#include "study/sweep/sweep.hpp"

#include <csignal>
#include <filesystem>
#include <fmt/format.h>
#include <sched.h>
#include <set>
#include <sstream>
#include <unistd.h>

#include "app/command/check.hpp"
#include "app/command/command.hpp"
#include "app/command/shared_options.hpp"
#include "app/experiment/plugins.hpp"
#include "app/experiment/reading.hpp"
#include "app/module/module_table.hpp"
#include "app/outputs/report.hpp"
#include "app/process/measure.hpp"
#include "app/process/progress.hpp"
#include "app/process/signals.hpp"
#include "app/process/terminal.hpp"
#include "app/study/cluster_sweep.hpp"
#include "app/study/register.hpp"
#include "app/study/slurm.hpp"
#include "app/study/sweep_plan.hpp"
#include "core/record/pattern.hpp"
#include "core/sim/incidents.hpp"
#include "hal/unit.hpp"
#include "study/batches/results.hpp"

namespace tandem::app {
namespace {

struct SweepOptions {
  Libraries plugins;
  std::string study;
  std::string table;      ///< empty: the study's
  std::int64_t jobs = 0;  ///< runs side by side; 0: as many as there are cores
  bool resume = false, retry_failed = false, accept_changes = false;
  bool yes = false;  ///< however many runs there are
  bool quiet = false;
  bool slurm = false;           ///< a cluster makes the runs
  std::int64_t batch_runs = 0;  ///< in a job of the cluster, at least; 0: chosen
  std::string sbatch;           ///< options of sbatch, parted by spaces
  std::string batch_folder;     ///< this process is a job: it makes batch `batch_number` of that folder's plan
  std::int64_t batch_number = 0;

  void describe(hal::CommandLine& line) {
    line.footer(
        "Exit code: 0 all runs are done, 1 bad input, 3 some have failed, now or before, 130 interrupted. What was "
        "made stays in the table, "
        "however the sweep ends.");
    line.word("study", study, "The study (.xml); `tandem describe study` tells what stands in it").required().file();
    line.option("--table", table, "Table to write, instead of the study's").file();
    line.option("--jobs", jobs, "Runs side by side; default: as many as there are cores").range(1, 4096);
    line.flag("--resume", resume, "Make the runs that the table lacks");
    line.flag("--retry-failed", retry_failed, "… and those that failed, again").needs("--resume");
    line.flag("--accept-changes", accept_changes, "… although program or files have changed").needs("--resume");
    line.flag("--yes", yes, "Do not ask, however many runs there are");
    line.flag("--quiet", quiet, "No summary at the end");
    line.flag("--slurm", slurm, "Have a cluster make the runs, by Slurm's sbatch, and wait for them");
    line.option("--batch", batch_runs, "Runs in one job of the cluster, at least; default: so that there are 64 jobs")
        .needs("--slurm")
        .range(1, 10'000'000);
    line.option("--sbatch", sbatch, "Options for sbatch, as one word: --sbatch='--partition=short --time=60'")
        .needs("--slurm");
    line.option("--batch-folder", batch_folder, "").hide();  // what the jobs of a cluster call
    line.option("--batch-number", batch_number, "").hide().needs("--batch-folder").not_negative();
    describe_plugins(line, plugins);
  }
};

namespace fs = std::filesystem;

constexpr std::int64_t kManyRuns = 100'000;
constexpr std::size_t kNamed = 10;  // causes of failed runs that are printed

std::size_t cores() {
  cpu_set_t set;
  CPU_ZERO(&set);
  if (sched_getaffinity(0, sizeof set, &set) != 0) return 1;
  return static_cast<std::size_t>(std::max(1, CPU_COUNT(&set)));
}

/// "1 run", "5 runs"
std::string counted(std::int64_t count, const std::string& thing) {
  return fmt::format("{} {}{}", count, thing, count == 1 ? "" : "s");
}

/// The command that goes on with a sweep that was started so.
std::string resume_command(const SweepOptions& options) {
  std::string command = "tandem sweep " + shell_word(options.study) + " --resume";
  if (!options.table.empty()) command += " --table " + shell_word(options.table);
  for (const std::string& plugin : options.plugins) command += " --plugin " + shell_word(plugin);
  return command;
}

/// Looks whether the first run that is done has what the study asks for, so that nobody learns after hours that a name
/// was misspelled.
class MeasureWatch {
 public:
  explicit MeasureWatch(const study::Study& study) : names_(study.measures) {
    for (const study::PublishedMeasure& m : study.published) names_.push_back(m.name);
  }
  void look_at(const study::FinishedRun& run) {
    if (looked_ || !run.outcome.done) return;
    looked_ = true;
    for (const std::string& name : names_) {
      const auto fits = [&](const auto& measure) { return core::fits_pattern(measure.first, name); };
      if (std::any_of(run.outcome.measures.begin(), run.outcome.measures.end(), fits)) continue;
      say(fmt::format("warning: run {} has no measure{}, which the study asks for", run.plan.number,
                      name == "*" ? "" : " '" + name + "'"));
    }
  }

 private:
  std::vector<std::string> names_;
  bool looked_ = false;
};

/// Whether so many runs are meant; asks a person who is there.
bool meant(std::int64_t runs, bool yes) {
  if (runs <= kManyRuns || yes) return true;
  if (isatty(STDIN_FILENO) == 0 || isatty(STDERR_FILENO) == 0) {
    complain(kBadInput, fmt::format("the study has {} runs; if they are meant, add --yes", runs));
    return false;
  }
  fmt::print(stderr, "The study has {} runs. Make them all? [y/N] ", runs);
  std::fflush(stderr);
  const int answer = std::getchar();
  return answer == 'y' || answer == 'Y';
}

/// The table of a sweep, with the runs that it lacks.
struct Work {
  std::unique_ptr<study::Table> table;
  std::int64_t version = 0;
  std::int64_t failed_before = 0;  ///< that are not made again
  bool begun = false;              ///< it was not there before
  std::vector<std::int64_t> runs;
};

std::optional<Work> open_work(const SweepOptions& options, const study::Design& design, const std::string& path,
                              const study::Version& version) {
  const auto refuse = [](const std::string& message) {
    complain(kBadInput, message);
    return std::nullopt;
  };
  auto opened = study::Table::open(path);
  if (!opened.ok()) return refuse(opened.error().message);
  Work work{std::move(opened).value(), 0, 0, false, {}};
  study::TableHead head{design.study().text, design.study().file, {}, design.runs()};
  for (const study::Parameter* p : design.study().parameters()) head.settings.push_back(p->name);
  std::vector<bool> there(static_cast<std::size_t>(design.runs()), false);
  if (const auto old = work.table->head()) {
    if (!options.resume) {
      return refuse("there is a table '" + path +
                    "' already: --resume makes the runs that it lacks, --table names another one");
    }
    const auto known = work.table->known();
    if (const hal::Status same = check_same_runs(design, *old, known); !same.ok())
      return refuse("'" + path + "': " + same.error().message);
    const auto last = work.table->version();
    if (last && !options.accept_changes) {
      if (const hal::Status same = check_same_version(*last, version); !same.ok())
        return refuse("'" + path + "': " + same.error().message);
    }
    for (const study::KnownRun& run : known) {
      if (run.done || !options.retry_failed) there[static_cast<std::size_t>(run.run)] = true;
      if (!run.done && !options.retry_failed) ++work.failed_before;
    }
    if (const hal::Status renewed = work.table->renew(head); !renewed.ok()) return refuse(renewed.error().message);
  } else {
    if (const hal::Status begun = work.table->begin(head); !begun.ok()) return refuse(begun.error().message);
    work.begun = true;
  }
  auto number = work.table->add_version(version);
  if (!number.ok()) return refuse(number.error().message);
  work.version = *number;
  for (std::int64_t run = 0; run < design.runs(); ++run) {
    if (!there[static_cast<std::size_t>(run)]) work.runs.push_back(run);
  }
  return work;
}

/// Runs that failed for one cause.
struct FailedRuns {
  std::string cause;  ///< as core::cause_of gives it
  study::RunPlan first;
  std::string why;  ///< of the first
  std::size_t others = 0;
};

/// What came of a sweep.
struct Tally {
  std::int64_t made = 0, failed = 0, failed_before = 0;
  double cpu_s = 0.0;
  std::vector<FailedRuns> causes;  ///< the first few
  bool more_causes = false;

  void note(const study::FinishedRun& run) {
    ++made;
    cpu_s += run.outcome.cpu_s;
    if (run.outcome.done) return;
    ++failed;
    std::string cause = core::cause_of(run.outcome.failure);
    const auto known = std::ranges::find(causes, cause, &FailedRuns::cause);
    if (known != causes.end())
      ++known->others;
    else if (causes.size() < kNamed)
      causes.push_back({std::move(cause), run.plan, run.outcome.failure});
    else
      more_causes = true;
  }
};

void tell(const Tally& tally, const study::Design& design, const SweepOptions& options, double took_s) {
  fmt::print("{} made in {}: {} done, {} failed; {} of processor time for them\n", counted(tally.made, "run"),
             duration_text(took_s), tally.made - tally.failed, tally.failed, duration_text(tally.cpu_s));
  for (const FailedRuns& runs : tally.causes) {
    fmt::print("{}: {}\n  {}\n", core::with_others(fmt::format("run {}", runs.first.number), runs.others, " failed"),
               printable(runs.why), command_of(design, runs.first));
  }
  if (tally.more_causes) fmt::print("… and for more reasons; the table's column 'failure' has all\n");
  if (tally.failed_before > 0) fmt::print("{} failed before; ", counted(tally.failed_before, "run"));
  if (tally.failed + tally.failed_before > 0) fmt::print("again: {} --retry-failed\n", resume_command(options));
}

study::SweepOptions how_to_sweep(const SweepOptions& options, const study::Study& study, const study::Design& design) {
  study::SweepOptions how;
  how.workers = options.jobs > 0 ? static_cast<std::size_t>(options.jobs) : cores();
  how.isolate = study.isolate;
  how.keeps_worlds = !design.names_runs();
  how.time_limit_s = study.time_limit_s;
  how.step_limit_s = study.step_limit_s;
  how.measuring = {study.measures, study.published, study.sample_every_s};
  return how;
}

/// What a cluster's jobs are told; the names are as this process sees them.
ClusterOptions cluster_options(const SweepOptions& options, const std::string& folder) {
  ClusterOptions cluster;
  cluster.folder = folder;
  cluster.batch_runs = static_cast<std::size_t>(options.batch_runs);
  cluster.workers = options.jobs > 0 ? static_cast<std::size_t>(options.jobs) : 1;
  std::error_code error;
  cluster.command = {fs::read_symlink("/proc/self/exe", error).string(), "sweep", options.study, "--jobs",
                     std::to_string(cluster.workers)};
  for (const std::string& plugin : options.plugins) cluster.command.insert(cluster.command.end(), {"--plugin", plugin});
  std::istringstream words(options.sbatch);
  for (std::string word; words >> word;) cluster.sbatch.push_back(word);
  return cluster;
}

std::optional<study::Study> read_study_or_complain(const std::string& path) {
  core::Problems problems;
  auto study = study::read_study(path, problems);
  print_problems(problems);
  return study;
}

/// Files of CSV that another table was written to are kept.
hal::Status keep_csv(const std::string& table) {
  for (const char* ending : {".csv", ".samples.csv"}) {
    if (hal::Status kept = keep_old(fs::path(table).replace_extension(ending).string()); !kept.ok()) return kept;
  }
  return {};
}

/// The table is whole: as CSV, and what to tell of it. `left`: runs that are missing. @returns the program's code.
int end_sweep(const SweepOptions& options, const study::Design& design, const std::string& path, const Tally& tally,
              std::int64_t left, double took_s, const std::string& go_on) {
  auto files = study::export_csv(path, fs::path(path).replace_extension(".csv").string());
  if (!files.ok()) {
    return complain(kFailedRunning,
                    fmt::format("{}. The table '{}' is whole; when that is mended, this writes it as CSV: {}",
                                files.error().message, path, go_on));
  }
  if (!options.quiet) {
    tell(tally, design, options, took_s);
    fmt::print("table: {}", path);
    for (const std::string& file : *files) fmt::print(", {}", file);
    fmt::print("\n");
  }
  if (left > 0) {
    say(fmt::format("interrupted: {} of {} runs are missing; {}: {}", left, design.runs(),
                    options.slurm ? "the cluster's jobs go on; collect what they make with" : "go on with", go_on));
    return interrupted_code() != 0 ? interrupted_code() : kFailedRunning;
  }
  return tally.failed + tally.failed_before > 0 ? kFailedRunning : kDone;
}

study::RunRow row_of(const study::FinishedRun& run, const study::Design& design, const core::Scenario& scenario,
                     std::int64_t version) {
  return {run.plan.number, design.study().experiments[run.plan.experiment].name,
          run.plan.seed,   design.values(run.plan.point),
          version,         1.0 / static_cast<double>(scenario.ticks_per_second),
          run.outcome};
}

int sweep(const SweepOptions& options) {
  const auto study = read_study_or_complain(options.study);
  if (!study) return kBadInput;
  auto made = study::Design::of(*study);
  if (!made.ok()) return complain(kBadInput, made.error().message);
  const study::Design& design = *made;
  if (options.slurm) {
    if (const hal::Status can = can_submit_jobs(); !can.ok()) return complain(kBadInput, can.error().message);
  }
  if (!meant(design.runs(), options.yes)) return kBadInput;
  hal::PluginLoader loader = make_loader();
  const auto experiments = judge(design, loader, options.plugins);
  if (!experiments) return kBadInput;
  const std::string path = options.table.empty() ? study->table : options.table;
  const std::string batches = fs::absolute(path).string() + ".batches";
  const std::string again = resume_command(options);
  if (!options.slurm && has_batches(batches)) {
    return complain(kBadInput, fmt::format("a cluster has made runs for this table, or makes them still: {} --slurm "
                                           "collects them. To forget them, remove '{}'",
                                           again, batches));
  }
  const std::atomic<bool>& stop = catch_signals();  // from here on there is a table to leave in order
  std::signal(SIGPIPE, SIG_IGN);
  const study::Version version = version_of(*experiments, loader);
  auto work = open_work(options, design, path, version);
  if (!work) return kBadInput;

  const std::string checkpoints = path + ".checkpoints";  // of runs that take long
  std::error_code none;
  if (!options.resume || options.accept_changes) fs::remove_all(checkpoints, none);

  const double began_s = wall_seconds();
  Tally tally;
  tally.failed_before = work->failed_before;
  hal::Status status;
  {
    const auto missing = static_cast<std::int64_t>(work->runs.size());
    const std::int64_t before = design.runs() - missing;
    Progress progress(design.runs(), 1, "sweep", "runs");
    progress.step(before);
    std::vector<study::RunRow> rows;
    MeasureWatch watch(*study);
    const auto take = [&](std::span<const study::FinishedRun> finished) {
      rows.clear();
      for (const study::FinishedRun& run : finished) {
        watch.look_at(run);
        rows.push_back(row_of(run, design, (*experiments)[run.plan.experiment], work->version));
        tally.note(run);
      }
      return work->table->add(rows);
    };
    const auto tick = [&] {
      progress.step(before + tally.made, tally.failed > 0 ? fmt::format(", {} failed", tally.failed) : "");
    };
    if (options.slurm) {
      status = sweep_on_cluster(design, work->runs, version, cluster_options(options, batches), take, tick, say, stop);
    } else {
      study::SweepOptions how = how_to_sweep(options, *study, design);
      how.checkpoints = checkpoints;
      how.in_worker = [&] { work->table->leave_to_parent(); };
      status = study::sweep(
          design, work->runs, [&](const study::RunPlan& plan) { return scenario_of(design, plan, loader); }, loader,
          how, take, tick, stop);
    }
  }
  const double took_s = wall_seconds() - began_s;
  if (status.ok()) status = work->table->finish();
  if (status.ok() && work->begun) status = keep_csv(path);
  const auto left = static_cast<std::int64_t>(work->runs.size()) - tally.made;
  if (left == 0) fs::remove_all(checkpoints, none);
  const std::string go_on = again + (options.slurm ? " --slurm" : "");
  if (!status.ok()) {
    return complain(kFailedRunning, fmt::format("{}. The table has the runs before; when that is mended: {}",
                                                status.error().message, go_on));
  }
  work->table.reset();
  return end_sweep(options, design, path, tally, left, took_s, go_on);
}

/// A job of a cluster: makes what is missing of one batch. kBadInput also where program or files are not those of the
/// sweep that planned it.
int sweep_batch(const SweepOptions& options) {
  auto plan = study::read_plan(options.batch_folder);
  if (!plan.ok()) return complain(kBadInput, plan.error().message);
  const auto batch = static_cast<std::size_t>(options.batch_number);
  if (batch >= plan->batches.size()) {
    return complain(kBadInput, fmt::format("there is no batch {} in '{}': there are {}", batch, options.batch_folder,
                                           plan->batches.size()));
  }
  const auto study = read_study_or_complain(options.study);
  if (!study) return kBadInput;
  auto made = study::Design::of(*study);
  if (!made.ok()) return complain(kBadInput, made.error().message);
  const study::Design& design = *made;
  hal::PluginLoader loader = make_loader();
  const auto experiments = judge(design, loader, options.plugins);
  if (!experiments) return kBadInput;
  if (const hal::Status same = check_same_version(plan->version, version_of(*experiments, loader)); !same.ok())
    return complain(kBadInput, "this job is to make runs of another program or files: " + same.error().message);

  // A job that was killed and started again goes on where it was.
  std::set<std::int64_t> there;
  for (const study::ToldOutcome& told : study::ResultsReader(options.batch_folder).look()) there.insert(told.run);
  std::vector<std::int64_t> runs;
  for (const std::int64_t run : plan->batches[batch]) {
    if (run < 0 || run >= design.runs())
      return complain(kBadInput, fmt::format("the plan has a run {}, and the study {} runs", run, design.runs()));
    if (there.count(run) == 0) runs.push_back(run);
  }
  auto results = study::ResultsWriter::open(options.batch_folder, batch);
  if (!results.ok()) return complain(kFailedRunning, results.error().message);
  const std::atomic<bool>& stop = catch_signals();
  std::signal(SIGPIPE, SIG_IGN);
  study::SweepOptions how = how_to_sweep(options, *study, design);
  how.checkpoints = options.batch_folder + "/checkpoints";
  const hal::Status status = study::sweep(
      design, runs, [&](const study::RunPlan& p) { return scenario_of(design, p, loader); }, loader, how,
      [&](std::span<const study::FinishedRun> finished) { return results->add(finished); }, [] {}, stop);
  if (!status.ok()) return complain(kFailedRunning, status.error().message);
  return interrupted_code();
}

int sweep_or_batch(const SweepOptions& options) {
  return options.batch_folder.empty() ? sweep(options) : sweep_batch(options);
}

/// `tandem check` of a study.
int check_study(const std::string& path, const Libraries& plugins) {
  const auto study = read_study_or_complain(path);
  if (!study) return kBadInput;
  auto design = study::Design::of(*study);
  if (!design.ok()) return complain(kBadInput, design.error().message);
  hal::PluginLoader loader = make_loader();
  if (!judge(*design, loader, plugins)) return kBadInput;
  const auto experiments_there = static_cast<std::int64_t>(study->experiments.size());
  fmt::print("{}: good: {}: {}, {} of {}, {}\n", path, counted(design->runs(), "run"),
             counted(experiments_there, "experiment"),
             counted(design->configurations() / experiments_there, "combination"),
             counted(static_cast<std::int64_t>(study->parameters().size()), "parameter"),
             counted(static_cast<std::int64_t>(study->seeds.size()), "seed"));
  return kDone;
}

}  // namespace

constinit const hal::CommandType sweep_command = module_command<SweepOptions, sweep_or_batch>("sweep");

constinit const CheckedFile study_file = {"study", &check_study};

}  // namespace tandem::app
