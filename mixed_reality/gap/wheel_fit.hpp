// Finds how a robot's wheels roll from a series of poses and commands: scales, wheel base, noise, delay.
//
// The commands, late by the delay, are what drives a filter for the pose (x, y, heading); the parameters are those
// under which the recorded poses are most likely: maximum likelihood of the filter's innovations [Ljung 1999, System
// Identification, section 7.4], by Fisher scoring. Standard errors are those of a model that need not be true: scores
// are added up over stretches of some seconds [White 1982, Econometrica 50(1)].
#pragma once
#include <cstdint>
#include <string>
#include <vector>

#include "hal/device/fitted.hpp"
#include "mixed_reality/gap/recorded_run.hpp"

namespace tandem::mixed_reality {

/// A number that was found.
struct Estimate {
  double value = 0.0;
  double error = 0.0;       ///< standard error
  bool observable = false;  ///< false: the data does not tell it; the value is the one from before

  /// Half of the interval that holds the true value in 95 of 100 cases.
  double bound() const noexcept { return 1.96 * error; }
};

struct WheelFit {
  std::string flaw;          ///< why nothing was found; empty: something was
  std::size_t ticks = 0;     ///< that were used
  std::size_t left_out = 0;  ///< ticks at which the robot was somewhere that no wheels explain: pushed, or carried
  Estimate left, right, base, delay_s, noise_sqrt_m;  ///< as hal::WheelModel
  Estimate counted_left, counted_right;
  Estimate slip_left, slip_right;  ///< parts of what encoders counted that did not become way
  Estimate mount_rad;              ///< of what trackers see of the robot, against its forward axis
  Estimate play_m;                 ///< of the gears: what a wheel loses whenever it turns round; not simulated
  double pose_noise_m = 0.0;       ///< standard deviation of the recorded poses
  double pose_noise_rad = 0.0;

  hal::WheelModel values() const noexcept;
  hal::WheelModel errors() const noexcept;
};

struct WheelFitOptions {
  double wheel_base_m = 0.0;     ///< of the kind
  bool poses_by_wheels = false;  ///< poses come from the wheels' encoders: they tell no scale
};

WheelFit fit_wheels(const RecordedRobot& robot, double tick_s, const WheelFitOptions& options);

}  // namespace tandem::mixed_reality
