// The commands for studies: `tandem sweep`, `tandem plot`, and `tandem check` of one.
#pragma once
#include <cstdint>
#include <string>
#include <utility>
#include <vector>

#include "app/command/command.hpp"

namespace tandem::app {

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
};
/// kFailedRunning: a run failed, or the table cannot be written.
int sweep(const SweepOptions& options);
/// A job of a cluster: makes what is missing of one batch. kBadInput also where program or files are not those of the
/// sweep that planned it.
int sweep_batch(const SweepOptions& options);

/// What is left empty is chosen from what the table has.
struct PlotOptions {
  std::string table;
  std::string output;  ///< .svg, .png or .pdf; empty: numbers and tests alone
  std::vector<std::string> measures;
  std::string over;                ///< "time", a column or a measure
  std::string by, panel;           ///< columns
  std::vector<std::string> where;  ///< "column=value"
  std::string show = "median";     ///< median, mean, box or runs
  std::string difference;          ///< the group that others are compared with, in pairs
  std::string title, x_label;
  std::vector<std::string> y_labels;  ///< of the measures, in their order
  bool log_x = false, from_zero = false, equal_axes = false;
  bool quiet = false;
};
int plot(const PlotOptions& options);

/// `check` for studies.
int check_study(const std::string& path, const Libraries& plugins);

}  // namespace tandem::app
