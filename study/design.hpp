// The runs of a study, numbered: which experiment, which values, which seed.
#pragma once
#include <cstdint>
#include <string>
#include <vector>

#include "hal/result.hpp"
#include "study/study.hpp"

namespace tandem::study {

/// One run. Runs of one configuration differ in their seed alone.
struct RunPlan {
  std::int64_t number = 0;
  std::int64_t configuration = 0;
  std::size_t experiment = 0;  ///< index into Study::experiments
  std::int64_t point = 0;      ///< of the grid of all axes
  std::uint64_t seed = 0;
};

/// Numbers the runs of a study: all configurations with the first seed, then all with the second, and so on, so that a
/// study with more seeds begins with the runs that it had. The last axis of the file changes fastest.
class Design {
 public:
  /// `study` must outlive this. Error: more runs than anybody can wait for (10^9).
  static hal::Result<Design> of(const Study& study);

  std::int64_t runs() const noexcept { return configurations_ * static_cast<std::int64_t>(study_->seeds.size()); }
  std::int64_t configurations() const noexcept { return configurations_; }
  RunPlan run(std::int64_t number) const;

  /// The value of every parameter, in the order of Study::parameters().
  std::vector<std::string> values(std::int64_t point) const;
  /// "path=value" of every constant and parameter of a run.
  std::vector<std::string> overrides(const RunPlan& plan) const;
  /// Whether a constant names the run or its seed: runs of one configuration are then different experiments.
  bool names_runs() const noexcept;

  const Study& study() const noexcept { return *study_; }

 private:
  explicit Design(const Study& study) : study_(&study) {}

  const Study* study_;
  std::int64_t points_ = 1;
  std::int64_t configurations_ = 1;
};

}  // namespace tandem::study
