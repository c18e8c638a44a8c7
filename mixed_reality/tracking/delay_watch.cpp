#include "mixed_reality/tracking/delay_watch.hpp"

#include <algorithm>

namespace tandem::mixed_reality {
namespace {

constexpr hal::TimeNs kPointEvery_ns = 20 * hal::kNsPerMs;
constexpr hal::TimeNs kStep_ns = 20 * hal::kNsPerMs;
constexpr hal::TimeNs kJudgeEvery_ns = 400 * hal::kNsPerMs;
constexpr double kGap_m = 0.5;                      // encoders that jump so far began anew
constexpr double kBetter_m = 0.002, kSigmas = 1.5;  // than with any delay that was counted on …
constexpr double kPart = 0.4;                       // … and so small a part of that
constexpr double kLonger_s = 0.02;                  // found again only where it is longer by this

hal::TimeNs to_ns(double s) noexcept {
  return static_cast<hal::TimeNs>(s * 1e9);
}

}  // namespace

void DelayWatch::told(hal::TimeNs now_ns, const hal::WheelSpeeds& wheels) noexcept {
  const bool stood = !ever_ && wheels.left_m_s == 0.0 && wheels.right_m_s == 0.0;  // nobody has told it anything
  if (stood) commands_.roll(now_ns - to_ns(kSpan_s) - 2 * kLongest_ns, 0.0, 0.0, wheel_base_m_);
  ever_ = true;
  if (telling_) {
    const double span_s = hal::to_seconds(now_ns - told_ns_);
    left_to_m_ += now_told_.left_m_s * span_s;
    right_to_m_ += now_told_.right_m_s * span_s;
  }
  const bool changes = !telling_ || wheels.left_m_s != now_told_.left_m_s || wheels.right_m_s != now_told_.right_m_s;
  const MotionTrail& trail = commands_.trail();
  if (trail.size() == 0 || now_ns - trail.newest().at_ns >= kPointEvery_ns) {
    commands_.roll(now_ns, left_to_m_, right_to_m_, wheel_base_m_);
    left_to_m_ = right_to_m_ = 0.0;
  }
  if (changes) changed_ns_ = now_ns;
  now_told_ = wheels;
  told_ns_ = now_ns;
  telling_ = true;
}

void DelayWatch::rolled(hal::TimeNs at_ns, double left_m, double right_m) noexcept {
  const MotionTrail& trail = wheels_.trail();
  if (rolling_ && trail.size() > 0 && at_ns - trail.newest().at_ns < kPointEvery_ns) return;
  const double left = rolling_ ? left_m - left_m_ : 0.0, right = rolling_ ? right_m - right_m_ : 0.0;
  if (!(std::abs(left) + std::abs(right) < kGap_m)) wheels_.clear();
  wheels_.roll(at_ns, trail.size() == 0 ? 0.0 : left, trail.size() == 0 ? 0.0 : right, wheel_base_m_);
  left_m_ = left_m;
  right_m_ = right_m;
  rolling_ = true;
}

void DelayWatch::seen(const PoseMeasurement& pose) noexcept {
  if (seen_.size() > 0 && pose.taken_ns - seen_.newest().at_ns < kPointEvery_ns) return;
  seen_.add({pose.taken_ns, pose.x_m, pose.y_m, pose.heading_rad, 0.0});
  sd_m_ = pose.sd_m;
}

void DelayWatch::forget() noexcept {
  commands_.clear();
  wheels_.clear();
  seen_.clear();
  telling_ = rolling_ = false;
  left_to_m_ = right_to_m_ = 0.0;
}

bool DelayWatch::judge(hal::TimeNs now_ns, double counted_s) noexcept {
  const hal::TimeNs span_ns = to_ns(kSpan_s);
  const bool steady = now_ns - changed_ns_ > span_ns + kLongest_ns;
  if (!telling_ || steady || now_ns - judged_ns_ < kJudgeEvery_ns) return false;
  judged_ns_ = now_ns;
  const MotionSpan span{now_ns - span_ns, now_ns};
  const double by_wheels_s = beyond_s(wheels_.trail(), 0.0, span, counted_s);
  const double by_trackers_s = beyond_s(seen_, sd_m_, span, counted_s);
  const double delay_found_s = std::max(by_wheels_s, by_trackers_s);
  if (delay_found_s <= 0.0) return false;
  const double before_s = delay_s();
  believed_s_[count_++ % believed_s_.size()] = delay_found_s;
  if (delay_found_s < before_s + kLonger_s) return false;
  told_by_ = by_wheels_s >= by_trackers_s ? "its wheels" : "trackers";
  return true;
}

double DelayWatch::delay_s() const noexcept {
  return *std::max_element(believed_s_.begin(), believed_s_.end());
}

/// The delay by which that motion follows the commands; 0: none that is longer than what is counted on, for sure.
double DelayWatch::beyond_s(const MotionTrail& motion, double sd_m, const MotionSpan& span,
                            double counted_s) const noexcept {
  const bool all_told = commands_.trail().size() > 0 && commands_.trail()[0].at_ns <= span.from_ns - kLongest_ns;
  const auto moved = apart_from_rest_m(motion, span);
  if (!all_told || !moved) return 0.0;
  const hal::TimeNs counted_ns = to_ns(counted_s + 0.25 * settle_s_);
  const auto within = best_delay(commands_.trail(), motion, span, 0, counted_ns, kStep_ns);
  const auto beyond = best_delay(commands_.trail(), motion, span, counted_ns + kStep_ns, kLongest_ns, kStep_ns);
  if (!within || !beyond || beyond->later_ns + kStep_ns > kLongest_ns) return 0.0;
  const bool clearly = within->apart_m - beyond->apart_m > kBetter_m + kSigmas * sd_m &&
                       beyond->apart_m < kPart * std::min(within->apart_m, *moved);
  return clearly ? hal::to_seconds(beyond->later_ns + kStep_ns / 2) : 0.0;
}

}  // namespace tandem::mixed_reality
