// A sweep on a cluster: hands batches of runs to Slurm through a folder, and collects their results.
#pragma once
#include <atomic>
#include <cstdint>
#include <functional>
#include <span>
#include <string>
#include <vector>

#include "hal/result.hpp"
#include "study/batches/plan.hpp"
#include "study/sweep/sweep.hpp"

namespace tandem::app {

struct ClusterOptions {
  std::string folder;          ///< for batches and results; all computers of the cluster see it under this name
  std::size_t batch_runs = 0;  ///< at least so many in a batch; 0: so that there are at most 64 batches
  std::size_t workers = 1;     ///< runs side by side in a batch
  std::vector<std::string>
      command;                      ///< makes a batch: the program and its arguments, all but those that name the batch
  std::vector<std::string> sbatch;  ///< options of sbatch
};

/// Makes `runs` as study::sweep does, on a cluster. First takes what is in the folder of a sweep that was interrupted,
/// and waits for its jobs where they are still under way. Batches that end without having made all their runs, because
/// a job was killed, say, are handed over again as long as each attempt brings some. When every run is there the folder
/// is removed. Ends early when `stop` is set: the jobs then go on by themselves.
/// `say` is called once for each job that is handed over. Errors: Slurm refuses; batches bring nothing; `take` fails.
hal::Status sweep_on_cluster(const study::Design& design, const std::vector<std::int64_t>& runs,
                             const study::Version& version, const ClusterOptions& options,
                             const std::function<hal::Status(std::span<const study::FinishedRun>)>& take,
                             const std::function<void()>& tick, const std::function<void(const std::string&)>& say,
                             const std::atomic<bool>& stop);

/// Whether a sweep that was interrupted has left batches there.
bool has_batches(const std::string& folder);

}  // namespace tandem::app
