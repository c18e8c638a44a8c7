// A robot whose parameters and delays are hidden from the fit, by an integrator of its own in steps of half a
// millisecond: nothing of it is shared with the fit or with the emulators.
#pragma once
#include <cmath>
#include <cstddef>
#include <limits>
#include <numbers>
#include <random>
#include <vector>

#include "mixed_reality/gap/wheel_series.hpp"

namespace tandem::mixed_reality {

struct HiddenRobot {
  // Of the body.
  double left = 1.0, right = 1.0, base = 1.0;  ///< way a way commanded, wheel base, of the data sheet's
  double wheel_noise = 0.003;                  ///< m after 1 m
  // Delays in seconds.
  double link_in = 0.0, command = 0.0, body = 0.0, counters = 0.0, link_out = 0.0;
  double command_jitter = 0.0;  ///< by which commands act sooner or later than that: standard deviation
  double right_later = 0.0;     ///< by which they act later on the right wheel
  double tracker_late = 0.0;    ///< of the tracker's stamps, although it says they are right
  // Of the measurements.
  double place_noise = 0.002, heading_noise = 0.015;
  double places_hz = 30.0;
  bool sees_heading = true;
  double count_step = 0.00013;  ///< of the counters
  // The drive.
  double base_m = 0.053, fastest = 0.1, seconds = 300.0, change_s = 1.0;
  unsigned seed = 1;

  WheelSeries drive() const {
    constexpr double kStep_s = 0.0005;
    constexpr double kTick_s = 0.1;
    std::mt19937_64 dice(seed);
    std::normal_distribution<double> gauss;
    std::uniform_real_distribution<double> even;
    WheelSeries series;
    // Commands, at the begin of a tick and a little later, as a program gives them.
    const auto ticks = static_cast<std::size_t>(seconds / kTick_s);
    for (std::size_t t = 0; t < ticks; ++t) {
      if (t > 0 && even(dice) > kTick_s / change_s) continue;
      const double at_s = static_cast<double>(t) * kTick_s + 0.002 * even(dice);
      series.commands.push_back({at_s, fastest * (1.4 * even(dice) - 0.4), fastest * (1.4 * even(dice) - 0.4), true});
    }
    std::vector<WheelSeries::Command> acting = series.commands;
    for (WheelSeries::Command& command_then : acting)
      if (command_jitter > 0.0) command_then.at_s += command_jitter * gauss(dice);
    // Where the floor and the motors were, at every step.
    const auto steps = static_cast<std::size_t>(seconds / kStep_s) + 1;
    std::vector<double> x(steps), y(steps), h(steps), motor_left(steps), motor_right(steps);
    // Looks up from where the last step was: commands are few.
    std::size_t motor_at = 0, floor_at = 0, right_at = 0;
    const auto hold = [&](std::size_t& at, double t_s) -> WheelSeries::Command {
      while (at < acting.size() && acting[at].at_s <= t_s) ++at;
      return at == 0 ? WheelSeries::Command{} : acting[at - 1];
    };
    for (std::size_t k = 0; k + 1 < steps; ++k) {
      const double t_s = (static_cast<double>(k) + 0.5) * kStep_s;
      const auto motor = hold(motor_at, t_s - link_in - command);
      motor_left[k + 1] = motor_left[k] + motor.left_m_s * kStep_s;
      motor_right[k + 1] = motor_right[k] + motor.right_m_s * kStep_s;
      const auto floor = hold(floor_at, t_s - link_in - command - body);
      const double right_m_s = hold(right_at, t_s - link_in - command - body - right_later).right_m_s;
      const auto rolled = [&](double speed, double scale) {
        const double way = scale * speed * kStep_s;
        return way == 0.0 ? 0.0 : way + wheel_noise * std::sqrt(std::fabs(way)) * gauss(dice);
      };
      const double l = rolled(floor.left_m_s, left), r = rolled(right_m_s, right);
      const double turn = (r - l) / (base_m * base);
      x[k + 1] = x[k] + 0.5 * (l + r) * std::cos(h[k] + 0.5 * turn);
      y[k + 1] = y[k] + 0.5 * (l + r) * std::sin(h[k] + 0.5 * turn);
      h[k + 1] = h[k] + turn;
    }
    const auto at = [&](const std::vector<double>& all, double t_s) {
      const double place = std::max(0.0, t_s / kStep_s);
      const auto i = std::min(static_cast<std::size_t>(place), steps - 2);
      const double part = std::min(1.0, place - static_cast<double>(i));
      return all[i] + part * (all[i + 1] - all[i]);
    };
    // What a tracker sees, at its own pace.
    for (double t_s = 0.013; t_s < seconds - 1.0; t_s += 1.0 / places_hz) {
      WheelSeries::Place place{t_s + tracker_late, at(x, t_s) + place_noise * gauss(dice),
                               at(y, t_s) + place_noise * gauss(dice)};
      const double heading = at(h, t_s) + heading_noise * gauss(dice);
      if (sees_heading) place.heading_rad = std::remainder(heading, 2.0 * std::numbers::pi);
      series.places.push_back(place);
    }
    // What the counters say, asked once a tick; the answer is stamped in the middle of question and answer.
    for (std::size_t t = 1; t + 20 < ticks; ++t) {
      const double asked_s = static_cast<double>(t) * kTick_s + 0.01 * even(dice);
      const double read_s = asked_s + link_in;
      const double stamp_s = asked_s + 0.5 * (link_in + link_out);
      const auto counted = [&](const std::vector<double>& motor) {
        return count_step * std::floor(at(motor, read_s - counters) / count_step);
      };
      series.counts.push_back({stamp_s, counted(motor_left), counted(motor_right)});
    }
    return series;
  }
};

}  // namespace tandem::mixed_reality
