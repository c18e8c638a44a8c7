#include "mixed_reality/barrier/motion_bound.hpp"

#include <algorithm>
#include <cmath>
#include <numbers>

#include "hal/device/brakes.hpp"

namespace tandem::mixed_reality {
namespace {

constexpr double kPi = std::numbers::pi;
constexpr double kLeast_m_s = 1e-9;  // slower is to stand

/// Whether an interval of angles holds `angle_rad`, or that and whole turns.
bool holds(double low_rad, double high_rad, double angle_rad) noexcept {
  const double turns = std::ceil((low_rad - angle_rad) / (2.0 * kPi));
  return angle_rad + turns * 2.0 * kPi <= high_rad;
}

void widen(Motion& low, Motion& high, const Motion& other_low, const Motion& other_high) noexcept {
  for (std::size_t c = 0; c < 3; ++c) {
    low.velocity[c] = std::min(low.velocity[c], other_low.velocity[c]);
    high.velocity[c] = std::max(high.velocity[c], other_high.velocity[c]);
  }
  low.turn_rad_s = std::min(low.turn_rad_s, other_low.turn_rad_s);
  high.turn_rad_s = std::max(high.turn_rad_s, other_high.turn_rad_s);
}

}  // namespace

MotionLimits motion_limits(const hal::RobotKind& kind) noexcept {
  MotionLimits limits{kind.body.radius_m, kind.body.height_m, 0.0, 0.0};
  if (const hal::DifferentialDrive* const drive = kind.drive(); drive != nullptr) {
    const auto* const brakes = kind.part<hal::BrakesPart>();
    const double deceleration_m_s2 =
        brakes != nullptr ? brakes->deceleration_m_s2 : hal::BrakesPart().deceleration_m_s2;
    limits.wheel_base_m = drive->wheel_base_m;
    limits.settle_s = 2.0 * drive->max_speed_m_s / deceleration_m_s2;  // from full speed to full speed back
  } else if (const hal::Quadrotor* const flight = kind.flight(); flight != nullptr) {
    limits.settle_s = flight->max_speed_m_s / flight->max_acceleration_m_s2 + flight->rotor_lag_s;
  }
  return limits;
}

// --- CommandTrail ---

void CommandTrail::note(hal::TimeNs sent_ns, const Motion& motion) noexcept {
  if (count_ > 0 && told_[count_ - 1].low == motion && told_[count_ - 1].high == motion) return;
  if (count_ == kMost) {
    widen(told_[0].low, told_[0].high, told_[1].low, told_[1].high);
    std::copy(told_.begin() + 2, told_.end(), told_.begin() + 1);
    --count_;
  }
  told_[count_++] = {sent_ns, motion, motion};
}

void CommandTrail::forget(hal::TimeNs before_ns) noexcept {
  std::size_t first = 0;
  while (first + 1 < count_ && told_[first + 1].from_ns < before_ns) ++first;
  if (first == 0) return;
  std::copy(told_.begin() + static_cast<std::ptrdiff_t>(first), told_.begin() + static_cast<std::ptrdiff_t>(count_),
            told_.begin());
  count_ -= first;
}

// --- MotionBound ---

void MotionBound::begin(const CommandTrail& trail, const Times& times, bool on_wheels) noexcept {
  on_wheels_ = on_wheels;
  count_ = 0;
  const auto reaction_ns = static_cast<hal::TimeNs>(times.reaction_s * 1e9);
  const hal::TimeNs end_ns = times.now_ns + times.tick_ns + reaction_ns;
  const std::size_t told = trail.size();
  // Until when each may move it.
  const auto until_ns = [&](std::size_t i) {
    return (i + 1 < told ? trail[i + 1].from_ns : times.now_ns) + reaction_ns;
  };
  hal::TimeNs at_ns = std::min(times.pose_ns, times.now_ns);
  std::size_t first = 0;  // that still may
  while (at_ns < end_ns) {
    while (first < told && until_ns(first) <= at_ns) ++first;
    hal::TimeNs next_ns = first < told ? std::min(end_ns, until_ns(first)) : end_ns;
    if (at_ns < times.now_ns) next_ns = std::min(next_ns, times.now_ns);
    Slice& slice = slices_[count_++];
    slice.span_s = hal::to_seconds(next_ns - at_ns);
    slice.now = at_ns >= times.now_ns;
    slice.low = slice.high = {};
    for (std::size_t i = first; i < told && trail[i].from_ns < next_ns; ++i)
      widen(slice.low, slice.high, trail[i].low, trail[i].high);
    at_ns = next_ns;
  }
}

void MotionBound::turn(const hal::Pose& pose, double error_rad, double turn_rad_s) noexcept {
  heading_rad_ = pose.heading_rad();
  double right_rad = -error_rad, left_rad = error_rad;
  for (std::size_t i = 0; i < count_; ++i) {
    Slice& slice = slices_[i];
    double low = std::min(0.0, slice.low.turn_rad_s), high = std::max(0.0, slice.high.turn_rad_s);
    if (slice.now) {
      low = std::min(low, turn_rad_s);
      high = std::max(high, turn_rad_s);
    }
    slice.turned_right_rad = right_rad += low * slice.span_s;
    slice.turned_left_rad = left_rad += high * slice.span_s;
  }
}

void MotionBound::look(const std::array<double, 3>& direction) noexcept {
  const double off_rad = on_wheels_ ? heading_rad_ - std::atan2(direction[1], direction[0]) : 0.0;
  for (std::size_t i = 0; i < count_; ++i) {
    Slice& slice = slices_[i];
    if (!on_wheels_) {
      double most = 0.0;
      for (std::size_t c = 0; c < 3; ++c)
        most += std::max(direction[c] * slice.low.velocity[c], direction[c] * slice.high.velocity[c]);
      slice.ahead_s = slice.span_s;
      slice.ahead_m_s = std::max(0.0, most);
      slice.back_s = slice.back_m_s = 0.0;
      continue;
    }
    if (direction[2] != 0.0) {
      slice.ahead_s = slice.back_s = slice.ahead_m_s = slice.back_m_s = 0.0;
      continue;
    }
    const double low_rad = off_rad + slice.turned_right_rad, high_rad = off_rad + slice.turned_left_rad;
    const double at_low = std::cos(low_rad), at_high = std::cos(high_rad);
    const double ahead = holds(low_rad, high_rad, 0.0) ? 1.0 : std::max(at_low, at_high);
    const double back = holds(low_rad, high_rad, kPi) ? 1.0 : -std::min(at_low, at_high);
    slice.ahead_s = slice.span_s * std::max(0.0, ahead);
    slice.back_s = slice.span_s * std::max(0.0, back);
    slice.ahead_m_s = std::max(0.0, slice.high.velocity[0]);
    slice.back_m_s = std::max(0.0, -slice.low.velocity[0]);
  }
}

double MotionBound::way_m(double speed_m_s) const noexcept {
  const double ahead = std::max(0.0, speed_m_s), back = std::max(0.0, -speed_m_s);
  double way = 0.0;
  for (std::size_t i = 0; i < count_; ++i) {
    const Slice& s = slices_[i];
    way += s.ahead_s * std::max(s.ahead_m_s, s.now ? ahead : 0.0) + s.back_s * std::max(s.back_m_s, s.now ? back : 0.0);
  }
  return way;
}

double MotionBound::own_way_m(double speed_m_s) const noexcept {
  double way = 0.0;
  for (std::size_t i = 0; i < count_; ++i) {
    const Slice& s = slices_[i];
    if (s.now) way += speed_m_s > 0.0 ? s.ahead_s * speed_m_s : -s.back_s * speed_m_s;
  }
  return way;
}

/// The way is a convex function of the speed, made of straight pieces: Newton's steps from above end after as many.
double MotionBound::most_m_s(double speed_m_s, double budget_m) const noexcept {
  double way = way_m(speed_m_s);
  if (way <= budget_m) return speed_m_s;
  const double sign = speed_m_s < 0.0 ? -1.0 : 1.0;
  double most = std::fabs(speed_m_s);
  for (std::size_t step = 0; step <= count_; ++step) {
    double slope = 0.0;
    for (std::size_t i = 0; i < count_; ++i) {
      const Slice& s = slices_[i];
      if (!s.now) continue;
      if (most > (sign > 0.0 ? s.ahead_m_s : s.back_m_s)) slope += sign > 0.0 ? s.ahead_s : s.back_s;
    }
    if (!(slope > 0.0)) return 0.0;
    most -= (way - budget_m) / slope;
    if (!(most > kLeast_m_s)) return 0.0;
    way = way_m(sign * most);
    if (way <= budget_m + 1e-12) return sign * most;
  }
  return 0.0;
}

double MotionBound::farthest_m(double speed_m_s) const noexcept {
  double way = 0.0;
  for (std::size_t i = 0; i < count_; ++i) {
    const Slice& s = slices_[i];
    double most2 = 0.0;
    for (std::size_t c = 0; c < 3; ++c) {
      const double v = std::max(std::fabs(s.low.velocity[c]), std::fabs(s.high.velocity[c]));
      most2 += v * v;
    }
    way += s.span_s * std::max(std::sqrt(most2), s.now ? speed_m_s : 0.0);
  }
  return way;
}

}  // namespace tandem::mixed_reality
