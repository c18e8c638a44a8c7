#include "mixed_reality/tracking/slip_watch.hpp"

#include <algorithm>
#include <cmath>

#include "mixed_reality/tracking/odometry.hpp"

namespace tandem::mixed_reality {

void SlipWatch::begin(const TrackedPose& tracked) noexcept {
  begun_ = true;
  begun_at_ns_ = tracked.taken_ns;
  from_ = reckoned_ = tracked.pose;
  way_m_ = wheels_m_ = 0.0;
}

SlipWatch::Found SlipWatch::judge(const TrackedPose& tracked) noexcept {
  if (encoders_.validity != hal::Validity::Fresh || !tracked.known) {
    begun_ = false;
    return Found::Nothing;
  }
  const double left_m = encoders_.left_m - left_m_;
  const double right_m = encoders_.right_m - right_m_;
  left_m_ = encoders_.left_m;
  right_m_ = encoders_.right_m;
  // A gap, or encoders that began anew: what was rolled meanwhile is not known.
  const bool gap = hal::to_seconds(tracked.taken_ns - last_ns_) > 0.5 * kSpan_s ||
                   !(std::fabs(left_m) + std::fabs(right_m) < kSpan_s);
  last_ns_ = tracked.taken_ns;
  if (!begun_ || gap) {
    begin(tracked);
    return Found::Nothing;
  }
  reckoned_ = rolled(reckoned_, left_m, right_m, wheel_base_m_);
  way_m_ += 0.5 * std::fabs(left_m + right_m);
  wheels_m_ += std::max(std::fabs(left_m), std::fabs(right_m));
  if (hal::to_seconds(tracked.taken_ns - begun_at_ns_) < kSpan_s) return Found::Nothing;
  const double apart_m = std::hypot(tracked.pose.x_m - reckoned_.x_m, tracked.pose.y_m - reckoned_.y_m);
  const bool differs = apart_m > kMost_m + kMostPart * way_m_;
  const double came_m = std::hypot(tracked.pose.x_m - from_.x_m, tracked.pose.y_m - from_.y_m);
  const bool moved = came_m > wheels_m_ + kMost_m;
  begin(tracked);
  return !differs ? Found::Nothing : moved ? Found::Moved : Found::Slip;
}

}  // namespace tandem::mixed_reality
