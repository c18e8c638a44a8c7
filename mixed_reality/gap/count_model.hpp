// How a robot's counters follow from its wheel commands: the likelihood of its encoders' readings.
#pragma once
#include <vector>

#include "mixed_reality/gap/likelihood.hpp"
#include "mixed_reality/gap/wheel_series.hpp"

namespace tandem::mixed_reality {

/// Each counter says `counted` times the way commanded, `delay` late; its error has a part that adds up (variance
/// walk^2 * |way|) and one that does not (rounding, stamps); and commands act a little sooner or later than in the
/// mean, which adds up, too (variance jitter^2 * change of speed^2).
class CountModel {
 public:
  enum Param : int { kLeft, kRight, kDelay, kWalk, kNoise, kJitter, kParams };
  using Likelihood = MaximumLikelihood<kParams, 2>;
  using Params = Likelihood::Params;

  /// `series` must outlive it.
  explicit CountModel(const WheelSeries& series);

  static Likelihood::Setup setup();
  /// Innovations of all counts; the last three parameters are logarithms (m after 1 m; m; s).
  void run(const Params& v, Likelihood::Innovations& out) const;

 private:
  struct Way {
    double left_m, right_m;
    std::size_t command;  // which holds then; 0: none yet
  };
  Way way_until(double t_s) const;

  const WheelSeries& series_;
  std::vector<Way> until_;  // each command's begin
};

}  // namespace tandem::mixed_reality
