// Finds how a robot's wheels roll from commands, measured places and counters: scales, wheel base, noise, delays.
//
// Two models by maximum likelihood: of the way (way_model.hpp), from commands and places, and of the counters
// (count_model.hpp), from commands and encoders. Neither looks at where the twin is drawn.
#pragma once
#include <optional>
#include <string>

#include "hal/device/fitted.hpp"
#include "mixed_reality/delay/delays.hpp"
#include "mixed_reality/gap/recorded_run.hpp"
#include "mixed_reality/gap/wheel_series.hpp"

namespace tandem::mixed_reality {

/// A number that was found.
struct Estimate {
  double value = 0.0;
  double error = 0.0;       ///< standard error
  bool observable = false;  ///< false: the data cannot tell it; the value is the one from before, there is no bound
  bool by_factor = false;   ///< the error is one of its logarithm: the interval is from low() to high(), not symmetric
  std::optional<double> most = {};  ///< of a value that may as well be 0: the interval is from there to this

  /// Half of the interval that holds the true value in 95 of 100 cases.
  double bound() const noexcept { return 0.5 * (high() - low()); }
  double low() const noexcept;
  double high() const noexcept;
};

struct WheelFit {
  std::string flaw;            ///< why nothing was found; empty: something was
  std::size_t ticks = 0;       ///< places that were used
  std::size_t left_out = 0;    ///< places at which the robot was somewhere that no wheels explain: pushed, or carried
  Estimate left, right, base;  ///< as hal::WheelModel
  Estimate noise_sqrt_m;       ///< of each wheel's way after 1 m
  Estimate delay_s;            ///< from a command's being given until the floor shows it
  Estimate counter_delay_s;    ///< … until the counters' stamps show it
  Estimate lag_s;              ///< by which the floor is later than the counters
  Estimate round_trip_s;       ///< of the link
  DelayParts parts;            ///< what the four leave of link, command, body, counters
  Estimate counted_left, counted_right;
  Estimate slip_left, slip_right;  ///< parts of what encoders counted that did not become way
  Estimate mount_rad;              ///< of what trackers see of the robot, against its forward axis
  Estimate play_m;                 ///< of the gears: what a wheel loses whenever it turns round; not simulated
  Estimate place_noise_m;          ///< of the trackers' x and y
  Estimate place_noise_rad;        ///< of their headings

  hal::WheelModel values() const noexcept;
  hal::WheelModel errors() const noexcept;
};

struct WheelFitOptions {
  double wheel_base_m = 0.0;     ///< of the kind
  bool poses_by_wheels = false;  ///< places come from the wheels' encoders: they tell no scale
  bool poses_drawn = false;      ///< places are a twin's, carried on and smoothed: they tell no delay
  std::optional<double> round_trip_s = {};
  double round_trip_jitter_s = 0.0;
};

WheelFit fit_wheels(const WheelSeries& series, const WheelFitOptions& options);
/// The same, of a series in which every tick is in its time.
WheelFit fit_wheels(const RecordedRobot& robot, double tick_s, const WheelFitOptions& options);

}  // namespace tandem::mixed_reality
