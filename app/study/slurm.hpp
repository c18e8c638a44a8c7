// Slurm by its own commands: job arrays are handed over with sbatch; squeue is asked where there is one.
#pragma once
#include <optional>
#include <string>
#include <vector>

#include "hal/result.hpp"

namespace tandem::app {

/// Success: this machine can hand jobs over. Error: it cannot, and what to do.
hal::Status can_submit_jobs();

/// Hands over `script` as a job array of `elements`; each finds its number, from 0, in SLURM_ARRAY_TASK_ID. `options`
/// are sbatch's. Error: what sbatch said. @returns the job's number
hal::Result<std::string> submit_array(const std::string& script, std::size_t elements,
                                      const std::vector<std::string>& options);

/// Has the cluster make the empty file `mark` when all of the job has ended, however that went.
hal::Status mark_end_of(const std::string& job, const std::string& mark, const std::vector<std::string>& options);

/// Whether Slurm still has the job. Nothing: it cannot be asked.
std::optional<bool> has_job(const std::string& job);

}  // namespace tandem::app
