#include "bridges/clock_estimator.hpp"

#include <algorithm>
#include <cmath>
#include <cstdlib>
#include <limits>

namespace tandem::bridges {
namespace {

using hal::TimeNs;

constexpr TimeNs kJump = hal::kNsPerSecond;
constexpr TimeNs kLate = 100 * hal::kNsPerMs;
constexpr unsigned kBelieveAfter = 5;
constexpr TimeNs kBurst = 50 * hal::kNsPerMs;
constexpr double kShift = 20e6;           // ns, by which the quickest messages differ for good
constexpr double kSlack = 5e6;            // ns, by which bounds may contradict each other before the clock was set
constexpr double kLongRoundTrip = 100e6;  // ns: tells nothing any more
constexpr std::size_t kSettled = 3;       // bins after which the shortest way has been seen
constexpr std::size_t kLearns = 4;        // bins from which a drift is learnt
constexpr double kApart_s = 0.1;          // of two bounds, at least, that tell of a drift
constexpr double kWander = 1e3;           // ns/s, that no drift is known better than: temperature
constexpr double kMostDrift = 2e6;        // ns/s: what is worse is no clock
constexpr double kPpm = 1e3;              // ns/s

}  // namespace

std::int64_t ClockEstimator::from_us(std::int64_t stamp_us) noexcept {
  return plausible(stamp_us) && stamp_us <= kLatest / 1000 ? stamp_us * 1000 : -1;
}

void ClockEstimator::begin(TimeNs difference, TimeNs received_ns) noexcept {
  begin_ns_ = bin_start_ns_ = received_ns;
  origin_ns_ = difference;
  first_ = 0;
  count_ = 1;
  bins_[0] = {};
  doubt_ = kUnknownDrift;  // `drift_` stays: the crystal is the same
  high_bins_ = late_in_row_ = odd_in_row_ = early_ = early_set_ = 0;
}

void ClockEstimator::note(std::int64_t stamp_ns, TimeNs received_ns) noexcept {
  if (!plausible(stamp_ns)) {
    ++implausible_;
    return;
  }
  ++messages_;
  const TimeNs difference = received_ns - stamp_ns;
  if (!known()) return begin(difference, received_ns);
  const double d = relative(difference);
  const Bounds b = bounds(seconds(received_ns));
  const bool before_it_was_sent = b.answered && d < b.below_least - kSlack;
  const bool set = before_it_was_sent || d < b.above - static_cast<double>(kJump);
  const bool too_early = count_ > kSettled && d < 2.0 * b.above - b.above_most - kShift;
  if (set || too_early) return note_early(difference, received_ns, set);
  if (d > b.above_most + static_cast<double>(kJump)) return note_odd(difference, received_ns);
  odd_in_row_ = 0;
  // A clock that was set shows its former time no more: those before had damaged stamps.
  if (early_ > 0 && relative(early_least_) < b.above - static_cast<double>(kJump)) early_ = early_set_ = 0;
  late_in_row_ = d > b.above + static_cast<double>(kLate) ? late_in_row_ + 1 : 0;
  if (received_ns - bin_start_ns_ >= kBin) next_bin(d, received_ns);
  Bin& last = bin(count_ - 1);
  if (d > last.above) return;
  last.above = d;
  last.above_at_s = seconds(received_ns);
}

/// Damaged stamps are few, and do not agree.
void ClockEstimator::note_early(TimeNs difference, TimeNs received_ns, bool set) noexcept {
  const bool goes_on =
      early_ > 0 && std::abs(difference - early_least_) <= kJump && received_ns - early_last_ns_ <= 2 * kBin;
  if (!goes_on) {
    early_ = early_set_ = 0;
    early_since_ns_ = received_ns;
    early_least_ = difference;
  }
  early_least_ = std::min(early_least_, difference);
  early_last_ns_ = received_ns;
  ++early_;
  early_set_ += set ? 1 : 0;
  if (early_ < kBelieveAfter || received_ns - early_since_ns_ < kBurst) return;
  ++(2 * early_set_ > early_ ? jumps_ : shifts_);
  begin(early_least_, received_ns);
}

/// Set back, or very late, or a damaged stamp: those that are to be believed agree.
void ClockEstimator::note_odd(TimeNs difference, TimeNs received_ns) noexcept {
  const bool agrees = odd_in_row_ > 0 && std::abs(difference - odd_least_) <= kJump;
  if (!agrees) odd_in_row_ = 0;
  if (!agrees) odd_since_ns_ = received_ns;
  odd_least_ = agrees ? std::min(odd_least_, difference) : difference;
  if (++odd_in_row_ < kBelieveAfter || received_ns - odd_since_ns_ < kBurst) return;
  ++jumps_;
  begin(odd_least_, received_ns);
}

void ClockEstimator::note_answer(std::int64_t stamp_ns, TimeNs sent_ns, TimeNs received_ns) noexcept {
  note(stamp_ns, received_ns);
  if (!plausible(stamp_ns)) return;
  ++exchanges_;
  const bool doubted = odd_in_row_ > 0 || (early_ > 0 && early_last_ns_ == received_ns);
  double below = relative(sent_ns - stamp_ns);
  if (below > bounds(seconds(received_ns)).above_most + kSlack) {
    ++jumps_;
    begin(received_ns - stamp_ns, received_ns);
    below = relative(sent_ns - stamp_ns);
  } else if (doubted) {
    return;
  }
  if (static_cast<double>(received_ns - sent_ns) > kLongRoundTrip) return;
  Bin& last = bin(count_ - 1);
  if (last.answered && below < last.below) return;
  last.answered = true;
  last.below = below;
  last.below_at_s = seconds(received_ns);
}

/// Begins the next bin with a message.
void ClockEstimator::next_bin(double difference, TimeNs received_ns) noexcept {
  const Bin closed = bin(count_ - 1);
  if (count_ > 1) {
    --count_;
    const Bounds before = bounds(closed.above_at_s);
    ++count_;
    const bool only_slower = closed.answered && closed.below <= before.above_most;
    high_bins_ = !only_slower && closed.above > before.above_most + kShift ? high_bins_ + 1 : 0;
  }
  if (high_bins_ >= 2) {
    first_ = (first_ + count_ - 2) % kBins;
    count_ = 2;
    high_bins_ = 0;
    doubt_ = kUnknownDrift;
    ++shifts_;
  }
  learn_drift();
  if (count_ == kBins) {
    first_ = (first_ + 1) % kBins;
    --count_;
  }
  bin(count_++) = {seconds(received_ns), difference, 0.0, 0.0, false};
  bin_start_ns_ = received_ns;
}

// --- drift ---

/// Of the line below all upper bounds that is nearest to them, and how far above it they lie in the mean.
double ClockEstimator::hull_slope(double& spread) const noexcept {
  std::array<const Bin*, kBins> hull{};
  std::size_t n = 0;
  double mean_s = 0.0, last_s = -std::numeric_limits<double>::infinity();
  for (std::size_t i = 0; i < count_; ++i) {
    const Bin& next = bin(i);
    if (next.above_at_s - last_s < kApart_s) continue;  // messages may be told in another order than they came
    last_s = next.above_at_s;
    mean_s += next.above_at_s / static_cast<double>(count_);
    const auto turns_up = [&] {
      const Bin &a = *hull[n - 2], &b = *hull[n - 1];
      return (b.above - a.above) * (next.above_at_s - a.above_at_s) <
             (next.above - a.above) * (b.above_at_s - a.above_at_s);
    };
    while (n >= 2 && !turns_up()) --n;
    hull[n++] = &next;
  }
  spread = 0.0;
  if (n < 2) return drift_;
  std::size_t i = 0;
  while (i + 2 < n && hull[i + 1]->above_at_s < mean_s) ++i;
  const Bin &a = *hull[i], &b = *hull[i + 1];
  const double slope = (b.above - a.above) / (b.above_at_s - a.above_at_s);
  for (std::size_t k = 0; k < count_; ++k)
    spread += (bin(k).above - a.above - slope * (bin(k).above_at_s - a.above_at_s)) / static_cast<double>(count_);
  return slope;
}

void ClockEstimator::learn_drift() noexcept {
  if (count_ < kLearns) return;
  double spread = 0.0;
  const double slope = hull_slope(spread);
  const double span_s = std::max(1.0, bin(count_ - 1).above_at_s - bin(0).above_at_s);
  // Between an upper bound and a lower one of another time the line has to pass.
  double least = -std::numeric_limits<double>::infinity(), most = -least;
  for (std::size_t i = 0; i < count_; ++i) {
    for (std::size_t k = 0; k < count_; ++k) {
      const double later_s = bin(i).above_at_s - bin(k).below_at_s;
      if (!bin(k).answered || std::fabs(later_s) < 1.0) continue;
      const double bound = (bin(i).above - bin(k).below) / later_s;
      later_s > 0.0 ? most = std::min(most, bound) : least = std::max(least, bound);
    }
  }
  if (least > most) {  // it drifts otherwise than it did
    first_ = (first_ + count_ / 2) % kBins;
    count_ -= count_ / 2;
    doubt_ = kUnknownDrift;
    return;
  }
  drift_ = std::clamp(std::clamp(slope, least, most), -kMostDrift, kMostDrift);
  doubt_ = std::isinf(least) || std::isinf(most) ? 4.0 * spread / span_s : std::max(most - drift_, drift_ - least);
  doubt_ = std::clamp(doubt_, kWander, kUnknownDrift);
}

// --- what is known ---

ClockEstimator::Bounds ClockEstimator::bounds(double at_s) const noexcept {
  Bounds b;
  b.above_most = std::numeric_limits<double>::infinity();
  b.below_least = -b.above_most;
  for (std::size_t i = 0; i < count_; ++i) {
    const Bin& one = bin(i);
    const double above_for_s = at_s - one.above_at_s, below_for_s = at_s - one.below_at_s;
    const double above = one.above + drift_ * above_for_s, below = one.below + drift_ * below_for_s;
    if (above + doubt_ * std::fabs(above_for_s) < b.above_most) {
      b.above = above;
      b.above_most = above + doubt_ * std::fabs(above_for_s);
    }
    if (!one.answered || below - doubt_ * std::fabs(below_for_s) <= b.below_least) continue;
    b.below = below;
    b.below_least = below - doubt_ * std::fabs(below_for_s);
    b.answered = true;
  }
  b.answered = b.answered && b.above_most - b.below_least <= kLongRoundTrip;
  return b;
}

TimeNs ClockEstimator::offset_ns(TimeNs at_ns) const noexcept {
  if (!known()) return 0;
  const Bounds b = bounds(seconds(at_ns));
  return origin_ns_ + static_cast<TimeNs>(std::llround(b.answered ? 0.5 * (b.above + b.below) : b.above));
}

TimeNs ClockEstimator::local(std::int64_t stamp_ns, TimeNs received_ns) const noexcept {
  if (!known() || !plausible(stamp_ns)) return received_ns;
  return std::min(received_ns, stamp_ns + offset_ns(received_ns));
}

ClockState ClockEstimator::state(TimeNs at_ns) const noexcept {
  ClockState state;
  state.messages = messages_;
  state.exchanges = exchanges_;
  state.jumps = jumps_;
  state.shifts = shifts_;
  state.implausible = implausible_;
  if (!known()) return state;
  const Bounds b = bounds(seconds(at_ns));
  state.offset_ns = offset_ns(at_ns);
  state.drift_ppm = drift_ / kPpm;
  state.drift_bound_ppm = doubt_ / kPpm;
  if (b.answered) {
    const double middle = 0.5 * (b.above + b.below);
    state.bound_ns = static_cast<TimeNs>(std::llround(std::max({b.above_most - middle, middle - b.below_least, 0.0})));
  }
  return state;
}

}  // namespace tandem::bridges
