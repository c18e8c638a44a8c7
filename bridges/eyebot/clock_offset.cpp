#include "bridges/eyebot/clock_offset.hpp"

#include <algorithm>

namespace tandem::bridges::eyebot {
namespace {

constexpr std::int64_t kLatest = 3'786'912'000'000'000;  // microseconds: the year 2090
constexpr hal::TimeNs kWindow = 5 * hal::kNsPerSecond;
constexpr hal::TimeNs kJump = hal::kNsPerSecond;
constexpr unsigned kBelieveAfter = 5;
constexpr hal::TimeNs kBurst = 50 * hal::kNsPerMs;
constexpr hal::TimeNs kBoundHolds = 10 * hal::kNsPerSecond;
constexpr hal::TimeNs kLongRoundTrip = 100 * hal::kNsPerMs;  // tells nothing any more

bool plausible(std::int64_t utime) noexcept {
  return utime >= 0 && utime <= kLatest;
}

}  // namespace

void ClockOffset::begin(hal::TimeNs least, hal::TimeNs received_ns) noexcept {
  known_ = true;
  least_ = least_before_ = least;
  window_start_ns_ = received_ns;
  bounded_ = false;
  late_in_row_ = 0;
}

void ClockOffset::note(std::int64_t utime, hal::TimeNs received_ns) noexcept {
  if (!plausible(utime)) {
    ++implausible_;
    return;
  }
  const hal::TimeNs difference = received_ns - utime * 1000;
  if (!known_) return begin(difference, received_ns);
  const hal::TimeNs least = std::min(least_, least_before_);
  if (difference < least - kJump) {  // set forward
    ++jumps_;
    return begin(difference, received_ns);
  }
  if (difference > least + kJump) {  // set back, or very late
    if (late_in_row_ == 0) late_since_ns_ = received_ns;
    late_least_ = late_in_row_ == 0 ? difference : std::min(late_least_, difference);
    if (++late_in_row_ < kBelieveAfter || received_ns - late_since_ns_ < kBurst) return;
    ++jumps_;
    return begin(late_least_, received_ns);
  }
  late_in_row_ = 0;
  if (received_ns - window_start_ns_ >= kWindow) {
    least_before_ = least_;
    least_ = difference;
    window_start_ns_ = received_ns;
  }
  least_ = std::min(least_, difference);
}

void ClockOffset::note_answer(std::int64_t utime, hal::TimeNs sent_ns, hal::TimeNs received_ns) noexcept {
  note(utime, received_ns);
  if (!known_ || !plausible(utime) || received_ns - sent_ns > kLongRoundTrip || late_in_row_ > 0) return;
  const hal::TimeNs below = sent_ns - utime * 1000;
  const bool outdated = !bounded_ || received_ns - below_at_ns_ > kBoundHolds;
  below_ = outdated ? below : std::max(below_, below);
  below_at_ns_ = received_ns;
  bounded_ = true;
}

hal::TimeNs ClockOffset::offset_ns() const noexcept {
  const hal::TimeNs above = std::min(least_, least_before_);
  if (!bounded_ || below_ > above || above - below_ > kLongRoundTrip) return above;
  return below_ + (above - below_) / 2;
}

hal::TimeNs ClockOffset::local(std::int64_t utime, hal::TimeNs received_ns) const noexcept {
  if (!known_ || !plausible(utime)) return received_ns;
  return std::min(received_ns, utime * 1000 + offset_ns());
}

}  // namespace tandem::bridges::eyebot
