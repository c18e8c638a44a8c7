#include "bridges/emulation/imperfect_wheels.hpp"

#include <algorithm>
#include <cmath>

namespace tandem::bridges {
namespace {

/// Bumps of about 20 cm, between -1 and 1, whose mean over the floor is 0.
double bump(double x_m, double y_m) {
  return std::sin(23.0 * x_m + 5.0 * y_m) * std::cos(17.0 * y_m - 3.0 * x_m);
}

}  // namespace

void WheelErrors::describe(hal::ParamVisitor& v) {
  v.number("left_wheel", left, hal::unit::none, {0.1, 10.0}, "What it rolls, as a part of what it should.");
  v.number("right_wheel", right, hal::unit::none, {0.1, 10.0}, "The same.");
  v.number("wheel_base", base, hal::unit::none, {0.1, 10.0}, "The wheel base that it turns by, of that it should.");
  v.number("wheel_delay", delay_s, hal::unit::s, {0.0, 10.0}, "By which its body is later than its motors.");
  v.number("wheel_noise", noise_sqrt_m, hal::unit::none, {0.0, 1.0},
           "Standard deviation of each wheel's way after 1 m, in m; it grows with the root of the way.");
  v.number("backlash", backlash_m, hal::unit::m, {0.0, 0.1}, "What a wheel loses whenever it turns round.");
  v.number("bumps", bumps, hal::unit::none, {0.0, 0.9},
           "By what part the floor changes what wheels roll, from place to place.");
  v.integer("wheel_seed", seed, {0, 999'999'999}, "Of the noise.");
}

bool WheelErrors::any() const noexcept {
  return left != 1.0 || right != 1.0 || base != 1.0 || delay_s > 0.0 || noise_sqrt_m > 0.0 || backlash_m > 0.0 ||
         bumps > 0.0;
}

ImperfectWheels::ImperfectWheels(const WheelErrors& errors)
    : errors_(errors),
      delay_ns_(static_cast<hal::TimeNs>(std::llround(errors.delay_s * 1e9))),
      random_(static_cast<std::uint64_t>(errors.seed)) {}

void ImperfectWheels::tell(hal::TimeNs now, double left_m_s, double right_m_s) {
  if (told_.back().left_m_s == left_m_s && told_.back().right_m_s == right_m_s) return;
  told_.push_back({now + delay_ns_, left_m_s, right_m_s});
}

bool ImperfectWheels::still() const noexcept {
  return std::all_of(told_.begin(), told_.end(), [](const Told& t) { return t.left_m_s == 0.0 && t.right_m_s == 0.0; });
}

ImperfectWheels::Ways ImperfectWheels::speeds_m_s(hal::TimeNs at) const noexcept {
  const Told* now = &told_.front();
  for (const Told& told : told_) {
    if (told.from <= at) now = &told;
  }
  return {now->left_m_s * errors_.left, now->right_m_s * errors_.right};
}

double ImperfectWheels::rolled(double way_m, double scale, double floor, double& play_m) {
  // The gear turns through its play first.
  const double moved_m = std::clamp(play_m + way_m, 0.0, errors_.backlash_m);
  const double way = (way_m - (moved_m - play_m)) * scale * floor;
  play_m = moved_m;
  if (errors_.noise_sqrt_m <= 0.0) return way;
  return way + errors_.noise_sqrt_m * std::sqrt(std::fabs(way)) * random_.normal();
}

ImperfectWheels::Ways ImperfectWheels::roll(hal::TimeNs from, hal::TimeNs until, double x_m, double y_m) {
  const double floor = 1.0 + errors_.bumps * bump(x_m, y_m);
  Ways ways;
  while (from < until) {
    while (told_.size() > 1 && told_[1].from <= from) told_.pop_front();
    const hal::TimeNs to = told_.size() > 1 ? std::min(until, told_[1].from) : until;
    const double s = hal::to_seconds(to - from);
    ways.left_m += rolled(told_.front().left_m_s * s, errors_.left, floor, play_left_m_);
    ways.right_m += rolled(told_.front().right_m_s * s, errors_.right, floor, play_right_m_);
    from = to;
  }
  return ways;
}

}  // namespace tandem::bridges
