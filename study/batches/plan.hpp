// The plan of batches: the runs of a study by jobs of a cluster, and their inputs.
#pragma once
#include <cstdint>
#include <string>
#include <vector>

#include "hal/result.hpp"
#include "study/table/table.hpp"

namespace tandem::study {

struct BatchPlan {
  Version version;                                 ///< program and files that the jobs must have, too
  std::vector<std::vector<std::int64_t>> batches;  ///< numbers of runs
};

/// Shares `runs` out: at most `most` batches, of `each` runs or more. Neighbours in a batch share a configuration where
/// they can, so that a worker keeps its world; run n has configuration n % `configurations`.
std::vector<std::vector<std::int64_t>> share_out(const std::vector<std::int64_t>& runs, std::int64_t configurations,
                                                 std::size_t each, std::size_t most);

/// As `plan.json` of a folder. Errors: the file cannot be written, or read; it is of another format.
hal::Status write_plan(const std::string& folder, const BatchPlan& plan);
hal::Result<BatchPlan> read_plan(const std::string& folder);

}  // namespace tandem::study
