#include "mixed_reality/tracking/positioned.hpp"

#include <cmath>

namespace tandem::mixed_reality {

Positioned::Positioned(const core::Pose& start, const hal::Positioning& places) : places_(places) {
  tracked_.pose = start;
}

TrackedPose Positioned::latch(const Moment& now) noexcept {
  if (places_.validity == hal::Validity::Absent) return tracked_;
  const hal::TimeNs taken_ns = now.monotonic_ns - (now.run_ns - places_.taken_ns);
  if (tracked_.known && taken_ns == tracked_.taken_ns) return tracked_;
  const auto& p = places_.p_WB;
  const auto& q = places_.q_WB;
  const double heading = std::atan2(2.0 * (q[0] * q[3] + q[1] * q[2]), 1.0 - 2.0 * (q[2] * q[2] + q[3] * q[3]));
  if (!std::isfinite(p[0] + p[1] + p[2] + heading)) {
    ++rejected_;
    return tracked_;
  }
  tracked_ = {core::Pose::at(p[0], p[1], heading, p[2]), taken_ns, true};
  return tracked_;
}

}  // namespace tandem::mixed_reality
