#include "bridges/eyebot/clock_offset.hpp"

#include <algorithm>
#include <cstdlib>

namespace tandem::bridges::eyebot {
namespace {

constexpr std::int64_t kLatest = 3'786'912'000'000'000;  // microseconds: the year 2090
constexpr hal::TimeNs kWindow = 5 * hal::kNsPerSecond;
constexpr hal::TimeNs kJump = hal::kNsPerSecond;
constexpr hal::TimeNs kLate = 100 * hal::kNsPerMs;
constexpr unsigned kBelieveAfter = 5;
constexpr hal::TimeNs kBurst = 50 * hal::kNsPerMs;
constexpr hal::TimeNs kBoundHolds = 10 * hal::kNsPerSecond;
constexpr hal::TimeNs kDriftSlack = 20 * hal::kNsPerMs;      // 200 parts in a million over the time that bounds hold
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
  odd_in_row_ = 0;
}

void ClockOffset::note(std::int64_t utime, hal::TimeNs received_ns) noexcept {
  if (!plausible(utime)) {
    ++implausible_;
    return;
  }
  const hal::TimeNs difference = received_ns - utime * 1000;
  if (!known_) return begin(difference, received_ns);
  const hal::TimeNs least = std::min(least_, least_before_);
  const bool bounded = bounded_ && received_ns - below_at_ns_ <= kBoundHolds;
  const hal::TimeNs floor = bounded ? std::max(below_ - kDriftSlack, least - kJump) : least - kJump;
  if (difference < floor || difference > least + kJump) return note_odd(difference, received_ns);
  odd_in_row_ = 0;
  late_in_row_ = difference > least + kLate ? late_in_row_ + 1 : 0;
  if (received_ns - window_start_ns_ >= kWindow) {
    least_before_ = least_;
    least_ = difference;
    window_start_ns_ = received_ns;
  }
  least_ = std::min(least_, difference);
}

/// Set forward or back, or very late, or a damaged stamp: those that are to be believed agree.
void ClockOffset::note_odd(hal::TimeNs difference, hal::TimeNs received_ns) noexcept {
  const bool agrees = odd_in_row_ > 0 && std::abs(difference - odd_least_) <= kJump;
  if (!agrees) odd_in_row_ = 0;
  if (!agrees) odd_since_ns_ = received_ns;
  odd_least_ = agrees ? std::min(odd_least_, difference) : difference;
  if (++odd_in_row_ < kBelieveAfter || received_ns - odd_since_ns_ < kBurst) return;
  ++jumps_;
  begin(odd_least_, received_ns);
}

void ClockOffset::note_answer(std::int64_t utime, hal::TimeNs sent_ns, hal::TimeNs received_ns) noexcept {
  note(utime, received_ns);
  if (!known_ || !plausible(utime)) return;
  const hal::TimeNs below = sent_ns - utime * 1000;
  if (below > std::min(least_, least_before_) + kDriftSlack) {
    ++jumps_;
    begin(received_ns - utime * 1000, received_ns);
  }
  if (received_ns - sent_ns > kLongRoundTrip || odd_in_row_ > 0) return;
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
