#include "bridges/epuck_emulator/stepper.hpp"

#include <algorithm>

namespace tandem::bridges::epuck_emulator {

void Stepper::set_speed(std::int32_t steps_s, hal::TimeNs now) {
  advance(now);
  const std::int32_t clamped = std::clamp(steps_s, -limit_steps_s_, limit_steps_s_);
  told_steps_s_ = clamped;
  direction_ = clamped > 0 ? 1 : clamped < 0 ? -1 : 0;
  if (direction_ == 0) {
    period_ns_ = 0;
    since_step_ns_ = 0;
    return;
  }
  period_ns_ = hal::kNsPerSecond / (clamped * direction_);
  if (tick_ns_ > 0) period_ns_ = std::max(tick_ns_, period_ns_ / tick_ns_ * tick_ns_);
}

void Stepper::advance(hal::TimeNs now) {
  if (now <= at_ns_) return;
  if (direction_ != 0) {
    since_step_ns_ += now - at_ns_;
    const hal::TimeNs steps = since_step_ns_ / period_ns_;
    since_step_ns_ -= steps * period_ns_;
    // The counter wraps, as the robot's does.
    count_ =
        static_cast<std::int32_t>(static_cast<std::uint32_t>(count_) + static_cast<std::uint32_t>(direction_ * steps));
  }
  at_ns_ = now;
}

double Stepper::real_steps_s() const noexcept {
  return direction_ == 0 ? 0.0 : direction_ * 1e9 / static_cast<double>(period_ns_);
}

}  // namespace tandem::bridges::epuck_emulator
