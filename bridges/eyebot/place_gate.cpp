#include "bridges/eyebot/place_gate.hpp"

#include <algorithm>
#include <cmath>

namespace tandem::bridges::eyebot {

bool PlaceGate::within_reach(const Sight& from, const Vector& place, hal::TimeNs taken_ns) const noexcept {
  const double way_m = std::hypot(place[0] - from.place[0], place[1] - from.place[1], place[2] - from.place[2]);
  const double time_s = hal::to_seconds(std::max<hal::TimeNs>(taken_ns - from.taken_ns, 0));
  return way_m <= kSlack_m + fastest_m_s_ * time_s;
}

bool PlaceGate::take(const Vector& place, hal::TimeNs taken_ns) noexcept {
  if (!known_ || within_reach(last_, place, taken_ns)) {
    known_ = true;
    odd_ = false;
    last_ = {place, taken_ns};
    return true;
  }
  if (!odd_ || !within_reach(elsewhere_, place, taken_ns)) odd_since_ns_ = taken_ns;
  odd_ = true;
  elsewhere_ = {place, taken_ns};
  if (taken_ns - odd_since_ns_ < kLasting) {
    ++refused_;
    return false;
  }
  ++jumps_;
  odd_ = false;
  last_ = elsewhere_;
  return true;
}

}  // namespace tandem::bridges::eyebot
