#include "app/study/cluster_sweep.hpp"

#include <chrono>
#include <filesystem>
#include <fmt/format.h>
#include <fstream>
#include <optional>
#include <thread>

#include "app/process/measure.hpp"
#include "app/process/terminal.hpp"
#include "app/study/slurm.hpp"
#include "hal/output_file.hpp"
#include "study/batches/results.hpp"

namespace tandem::app {
namespace {

namespace fs = std::filesystem;

constexpr std::size_t kMostBatches = 64;     // where the user names no size
constexpr std::size_t kMostElements = 1000;  // of a job array, by Slurm's default (MaxArraySize)
constexpr std::size_t kFewestRuns = 8;       // in a batch: a job costs up to a second
constexpr auto kLookEvery = std::chrono::milliseconds(200);
constexpr double kAskEvery_s = 3.0;  // squeue
constexpr double kGrace_s = 2.0;     // for files of other computers to be seen here, after their job has ended

std::string first_line(const fs::path& file) {
  std::ifstream in(file);
  std::string line;
  std::getline(in, line);
  return line;
}

/// The last words of any job, for messages.
std::string last_words(const fs::path& folder) {
  std::error_code error;
  for (const fs::directory_entry& entry : fs::directory_iterator(folder, error)) {
    if (entry.path().extension() != ".txt") continue;
    std::ifstream in(entry.path());
    std::string last;
    for (std::string line; std::getline(in, line);) {
      if (!line.empty()) last = line;
    }
    if (!last.empty()) return entry.path().string() + ": " + last;
  }
  return {};
}

std::string script_of(const std::vector<std::string>& command, const std::string& folder) {
  std::string text =
      "#!/bin/sh\n# Makes one batch of a sweep's runs.\ncd " + shell_word(fs::current_path().string()) + " && exec";
  for (const std::string& word : command) text += " " + shell_word(word);
  return text + " --batch-folder " + shell_word(folder) + " --batch-number \"$SLURM_ARRAY_TASK_ID\"\n";
}

/// One job array and its folder.
class Attempt {
 public:
  explicit Attempt(fs::path folder) : folder_(std::move(folder)), results_(folder_.string()) {
    job_ = first_line(folder_ / "job");
  }

  const std::string& job() const noexcept { return job_; }
  std::vector<study::ToldOutcome> look() { return results_.look(); }

  /// Whether nothing more comes of it.
  bool over() {
    std::error_code error;
    if (!ended_s_ && (job_.empty() || fs::exists(folder_ / "over", error))) ended_s_ = wall_seconds();
    if (!ended_s_ && wall_seconds() - asked_s_ > kAskEvery_s) {
      asked_s_ = wall_seconds();
      if (has_job(job_) == std::optional(false)) ended_s_ = wall_seconds();
    }
    return ended_s_ && wall_seconds() - *ended_s_ > kGrace_s;
  }

 private:
  fs::path folder_;
  study::ResultsReader results_;
  std::string job_;  // empty: it was never handed over
  double asked_s_ = 0.0;
  std::optional<double> ended_s_;
};

/// The attempts of a sweep: folders "1", "2", … in its own.
class Attempts {
 public:
  Attempts(const study::Version& version, const ClusterOptions& options) : version_(version), options_(options) {
    while (fs::exists(folder_of(attempts_.size() + 1))) attempts_.emplace_back(folder_of(attempts_.size() + 1));
  }

  bool any() const noexcept { return !attempts_.empty(); }
  std::size_t count() const noexcept { return attempts_.size(); }
  Attempt& last() noexcept { return attempts_.back(); }

  std::vector<study::ToldOutcome> look() {
    std::vector<study::ToldOutcome> all;
    for (Attempt& attempt : attempts_) {
      for (study::ToldOutcome& told : attempt.look()) all.push_back(std::move(told));
    }
    return all;
  }

  /// Hands `runs` over. @returns what to tell the user
  hal::Result<std::string> begin(const std::vector<std::int64_t>& runs, std::int64_t configurations) {
    const fs::path folder = folder_of(attempts_.size() + 1);
    std::error_code error;
    fs::create_directories(folder, error);
    if (error) return hal::Error{"folder '" + folder.string() + "' cannot be made: " + error.message()};
    const bool chosen = options_.batch_runs > 0;
    study::BatchPlan plan{version_, study::share_out(runs, configurations, chosen ? options_.batch_runs : kFewestRuns,
                                                     chosen ? kMostElements : kMostBatches)};
    if (const hal::Status written = study::write_plan(folder.string(), plan); !written.ok()) return written.error();
    const std::string script = (folder / "batch.sh").string();
    if (const hal::Status written =
            hal::write_whole_file(script, "script", script_of(options_.command, folder.string()));
        !written.ok())
      return written.error();
    std::vector<std::string> options = {"--job-name=tandem-sweep", "--requeue", "--open-mode=append",
                                        "--output=" + (folder / "output-%a.txt").string(),
                                        "--cpus-per-task=" + std::to_string(options_.workers)};
    options.insert(options.end(), options_.sbatch.begin(), options_.sbatch.end());
    auto job = submit_array(script, plan.batches.size(), options);
    if (!job.ok()) {
      fs::remove_all(folder, error);
      return job.error();
    }
    if (const hal::Status noted = hal::write_whole_file((folder / "job").string(), "job's number", *job + "\n");
        !noted.ok())
      return noted.error();
    attempts_.emplace_back(folder);
    std::vector<std::string> mark_options = {"--job-name=tandem-sweep-end"};
    mark_options.insert(mark_options.end(), options_.sbatch.begin(), options_.sbatch.end());
    if (const hal::Status marked = mark_end_of(*job, (folder / "over").string(), mark_options); !marked.ok())
      return marked.error();
    return fmt::format("job {} makes {} runs in {} batches; it goes on when this ends, and `scancel {}` ends it", *job,
                       runs.size(), plan.batches.size(), *job);
  }

 private:
  fs::path folder_of(std::size_t number) const { return fs::path(options_.folder) / std::to_string(number); }

  const study::Version& version_;
  const ClusterOptions& options_;
  std::vector<Attempt> attempts_;
};

}  // namespace

bool has_batches(const std::string& folder) {
  std::error_code error;
  return fs::exists(fs::path(folder) / "1" / "plan.json", error);
}

hal::Status sweep_on_cluster(const study::Design& design, const std::vector<std::int64_t>& runs,
                             const study::Version& version, const ClusterOptions& options,
                             const std::function<hal::Status(std::span<const study::FinishedRun>)>& take,
                             const std::function<void()>& tick, const std::function<void(const std::string&)>& say,
                             const std::atomic<bool>& stop) {
  std::vector<bool> wanted(static_cast<std::size_t>(design.runs()), false);
  for (const std::int64_t run : runs) wanted[static_cast<std::size_t>(run)] = true;
  auto left = static_cast<std::int64_t>(runs.size());
  Attempts attempts(version, options);
  bool handed_over = false;           // by this sweep
  std::int64_t left_at_begin = left;  // of the last attempt
  while (left > 0 && !stop.load(std::memory_order_relaxed)) {
    const bool over = !attempts.any() || attempts.last().over();  // before looking: what came until then is seen
    std::vector<study::FinishedRun> finished;
    for (study::ToldOutcome& told : attempts.look()) {
      if (told.run < 0 || told.run >= design.runs() || !wanted[static_cast<std::size_t>(told.run)]) continue;
      wanted[static_cast<std::size_t>(told.run)] = false;
      finished.push_back({design.run(told.run), std::move(told.outcome)});
    }
    left -= static_cast<std::int64_t>(finished.size());
    if (!finished.empty()) {
      if (const hal::Status taken = take(finished); !taken.ok()) return taken;
    }
    tick();
    if (left == 0) break;
    if (!over) {
      std::this_thread::sleep_for(kLookEvery);
      continue;
    }
    if (handed_over && left == left_at_begin) {
      const std::string words = last_words(options.folder + "/" + std::to_string(attempts.count()));
      return hal::Error{"the batches of job " + attempts.last().job() + " have ended, and made no run" +
                        (words.empty() ? "" : ": " + words)};
    }
    std::vector<std::int64_t> missing;
    for (const std::int64_t run : runs) {
      if (wanted[static_cast<std::size_t>(run)]) missing.push_back(run);
    }
    auto begun = attempts.begin(missing, design.configurations());
    if (!begun.ok()) return begun.error();
    say(*begun);
    handed_over = true;
    left_at_begin = left;
  }
  if (left > 0) return {};
  std::error_code error;
  fs::remove_all(options.folder, error);
  return {};
}

}  // namespace tandem::app
