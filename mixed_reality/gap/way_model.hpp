// How places follow from wheel commands: the likelihood of the sightings of one robot.
#pragma once
#include <vector>

#include "mixed_reality/gap/likelihood.hpp"
#include "mixed_reality/gap/wheel_series.hpp"

namespace tandem::mixed_reality {

/// A filter over the pose (x, y, heading), driven by the commands as they were given, `delay` late, and corrected by
/// each place at its own time.
///
/// Wheel i rolls `scale_i` times the way commanded, with noise of variance noise^2 * |way|; the robot turns by
/// (right - left) / (`base` * the kind's wheel base). Each command acts a little sooner or later than in the mean, and
/// on one wheel sooner than on the other (motors on a bus hear one after the other), which adds up: variance jitter^2
/// of both together, apart^2 of the one against the other, by the square of what the speeds change by. A wheel that
/// turns round loses `play`. Places have white noise; a heading is seen `mount` to the left of the robot's.
class WayModel {
 public:
  enum Param : int {
    kLeft,
    kRight,
    kBase,
    kDelay,
    kMount,
    kPlay,
    kNoise,
    kJitter,
    kApart,
    kPlaceM,
    kPlaceRad,
    kParams
  };
  using Likelihood = MaximumLikelihood<kParams, 3, 2>;
  using Params = Likelihood::Params;

  static constexpr double kElsewhere = 60.0;  ///< chi square that no noise explains: the robot was pushed, or carried

  /// `series` must outlive it.
  WayModel(const WheelSeries& series, double wheel_base_m)
      : series_(series), wheel_base_m_(wheel_base_m), elsewhere_(series.places.size(), 0) {}

  static Likelihood::Setup setup();
  /// Innovations of all places. Parameters of noise are logarithms (m after 1 m; s; s; m; rad).
  void run(const Params& v, Likelihood::Innovations& out) const;
  /// Those that have nothing to do with the one before: the filter starts again there. @returns whether there were new
  /// ones.
  bool leave_out(const Likelihood::Innovations& innovations);
  std::size_t left_out() const noexcept;

 private:
  const WheelSeries& series_;
  double wheel_base_m_;
  std::vector<char> elsewhere_;
};

}  // namespace tandem::mixed_reality
