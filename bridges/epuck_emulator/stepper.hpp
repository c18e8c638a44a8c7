// A stepper motor and the counter of its steps.
#pragma once
#include <cstdint>

#include "hal/time.hpp"

namespace tandem::bridges::epuck_emulator {

/// Steps as commanded, in integer time: no drift however long it turns. The count says nothing of slip or of a blocked
/// wheel.
class Stepper {
 public:
  /// `limit_steps_s`: faster commands are clamped. `tick_ns`: a step lasts a whole number of these; 0 for any duration.
  Stepper(std::int32_t limit_steps_s, hal::TimeNs tick_ns) : limit_steps_s_(limit_steps_s), tick_ns_(tick_ns) {}

  /// Turns at `steps_s` from `now` on. Times must not decrease.
  void set_speed(std::int32_t steps_s, hal::TimeNs now);
  /// Counts on to `now`.
  void advance(hal::TimeNs now);

  std::int32_t count() const noexcept { return count_; }
  void set_count(std::int32_t count) noexcept { count_ = count; }
  /// The speed that the motor has: signed steps a second, after clamping and rounding of the period.
  double real_steps_s() const noexcept;
  /// The commanded speed, after clamping.
  std::int32_t told_steps_s() const noexcept { return told_steps_s_; }

 private:
  std::int32_t limit_steps_s_;
  hal::TimeNs tick_ns_;
  std::int32_t told_steps_s_ = 0, direction_ = 0;
  hal::TimeNs period_ns_ = 0;      // of one step; 0: at rest
  hal::TimeNs since_step_ns_ = 0;  // part of a period that has passed
  hal::TimeNs at_ns_ = 0;
  std::int32_t count_ = 0;
};

}  // namespace tandem::bridges::epuck_emulator
