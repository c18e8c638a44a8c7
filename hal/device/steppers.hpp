// Stepper motors: how fast wheels turn whose steps last whole periods of a timer.
#pragma once
#include <algorithm>
#include <cmath>
#include <cstdint>
#include <numbers>
#include <string>

#include "hal/params.hpp"
#include "hal/robot_kind.hpp"

namespace tandem::hal {

/// A part of robots whose wheels are turned by stepper motors. The wheels of those without turn as commanded.
struct SteppersPart {
  static constexpr std::string_view kName = "steppers";
  static constexpr std::string_view kDoc = "Stepper motors, whose steps last whole periods of a timer.";
  std::int64_t steps_per_turn = 1000;
  double timer_Hz = 10000.0;
  std::string source = {};

  /// Speed in steps a second of a motor that is told this one: a whole number of steps a second, and then the whole
  /// periods, cut off, that such a step lasts; at least one.
  double turned_steps_s(double told_steps_s) const noexcept {
    const double whole = std::round(told_steps_s);
    if (whole == 0.0) return 0.0;
    return std::copysign(timer_Hz / std::max(1.0, std::trunc(timer_Hz / std::fabs(whole))), whole);
  }
  double step_m(double wheel_radius_m) const noexcept {
    return 2.0 * std::numbers::pi * wheel_radius_m / static_cast<double>(steps_per_turn);
  }

  void describe(ParamVisitor& v) {
    v.integer("steps_per_turn", steps_per_turn, {1, 1e6}, "Steps in which a wheel turns once.");
    v.number("timer", timer_Hz, unit::hz, {1.0, 1e9}, "A step lasts a whole number of its periods.");
    v.text("source", source, "Where these figures come from.");
  }
};

}  // namespace tandem::hal
