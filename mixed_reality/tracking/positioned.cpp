#include "mixed_reality/tracking/positioned.hpp"

#include <algorithm>
#include <cmath>

namespace tandem::mixed_reality {
namespace {

constexpr double kSpeedMargin = 1.5;   // robots are faster for a moment, and stamps jitter
constexpr double kStepMargin_m = 0.1;  // noise of two places

}  // namespace

Positioned::Positioned(const core::Pose& start, const hal::Positioning& places, const hal::RobotKind& kind)
    : places_(places), max_speed_m_s_(kind.top_speed_m_s()) {
  tracked_.pose = start;
}

TrackedPose Positioned::latch(const Moment& now) noexcept {
  if (places_.validity == hal::Validity::Absent) return tracked_;
  const hal::TimeNs taken_ns = now.to_monotonic(places_.taken_ns);
  if (taken_ns == seen_ns_) return tracked_;
  const auto& p = places_.p_WB;
  const auto& q = places_.q_WB;
  const double heading = std::atan2(2.0 * (q[0] * q[3] + q[1] * q[2]), 1.0 - 2.0 * (q[2] * q[2] + q[3] * q[3]));
  if (taken_ns > now.monotonic_ns || !std::isfinite(p[0] + p[1] + p[2] + heading)) {
    if (places_.taken_ns != future_ns_) ++rejected_;
    future_ns_ = places_.taken_ns;
    return tracked_;
  }
  seen_ns_ = taken_ns;
  if (tracked_.known && taken_ns <= tracked_.taken_ns) return tracked_;
  TrackedPose said{core::Pose::at(p[0], p[1], heading, p[2]), taken_ns, true};
  said.q_WB.emplace();
  std::copy(q.begin(), q.end(), said.q_WB->begin());
  if (tracked_.known && !reachable(tracked_, said.pose, taken_ns)) {
    ++rejected_;
    insisted_ = insisted_ > 0 && reachable(other_, said.pose, taken_ns) ? insisted_ + 1 : 1;
    other_ = said;
    if (insisted_ < kInsists) return tracked_;
    ++jumps_;
  }
  insisted_ = 0;
  tracked_ = said;
  return tracked_;
}

bool Positioned::reachable(const TrackedPose& from, const core::Pose& to, hal::TimeNs at_ns) const noexcept {
  const double x_m = to.x_m - from.pose.x_m;
  const double y_m = to.y_m - from.pose.y_m;
  const double z_m = to.z_m - from.pose.z_m;
  const double most_m = kSpeedMargin * max_speed_m_s_ * hal::to_seconds(at_ns - from.taken_ns) + kStepMargin_m;
  return x_m * x_m + y_m * y_m + z_m * z_m <= most_m * most_m;
}

}  // namespace tandem::mixed_reality
