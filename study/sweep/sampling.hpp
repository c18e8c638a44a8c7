// Collects the measures of a run: at its end, and over time.
#pragma once
#include <string>
#include <vector>

#include "core/sim/world.hpp"
#include "study/run_row.hpp"
#include "study/study.hpp"

namespace tandem::study {

/// What is measured, of a study.
struct Measuring {
  std::vector<std::string> names = {"*"};  ///< of what hooks publish; patterns with '*'
  std::vector<PublishedMeasure> published;
  double every_s = 0.0;  ///< 0: at the end alone
};

/// The measures of a world now, by name and sorted by it. A published value that no robot has is left out.
std::vector<std::pair<std::string, double>> measure(const core::World& world, const Measuring& what);

/// Samples one run.
class Sampler {
 public:
  Sampler(const Measuring& what, std::int64_t ticks_per_second);

  /// After every tick. A hook that went back in time takes the samples of the time after with it.
  void tick_done(const core::World& world);
  void remember(hal::Archive& archive) { archive(ticks_, values_); }
  /// Hands over what was sampled.
  void take(RunOutcome& outcome);

 private:
  const Measuring& what_;
  std::int64_t every_ = 0;  // ticks
  std::vector<std::int64_t> ticks_;
  std::vector<std::pair<std::string, std::vector<double>>> values_;
};

}  // namespace tandem::study
