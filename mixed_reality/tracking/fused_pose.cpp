#include "mixed_reality/tracking/fused_pose.hpp"

#include <algorithm>
#include <cmath>
#include <limits>
#include <numbers>
#include <utility>

#include "hal/angle.hpp"
#include "mixed_reality/delay/delays.hpp"
#include "mixed_reality/tracking/commanded_motion.hpp"

namespace tandem::mixed_reality {
namespace {

constexpr double kSpeedMargin = 1.25;   // firmwares clamp above the kind's speed, and stamps jitter
constexpr double kStepMargin_m = 0.01;  // what jitter of the stamps may add in a short step
constexpr double kAgree_m = 0.03, kAgree_rad = 0.15;
constexpr double kUnknown_m = 1.0, kUnknown_rad = 1.0;  // standard deviations before it was found
constexpr double kGuess_rad = 0.2;                      // of the heading that the file says
constexpr double kSteady_rad_s = 0.3;  // change of a turn rate from which a gyroscope read now and then tells no turn
constexpr double kUnseenSlip = 2.0;    // of the wheels' noise: what a gyroscope that is read now and then does not see
constexpr hal::TimeNs kGyroscopeFits_ns = 20 * hal::kNsPerMs;

}  // namespace

FusedPose::FusedPose(const core::Pose& start, const hal::DifferentialDrive& drive, const hal::WheelEncoders& encoders,
                     const hal::Gyroscope* gyroscope, const FusedPoseParams& params)
    : encoders_(encoders),
      gyroscope_(gyroscope),
      wheel_base_m_(drive.wheel_base_m),
      params_(params),
      max_speed_m_s_(drive.max_speed_m_s),
      filter_(start, 0, kUnknown_m, kUnknown_rad, drive.wheel_base_m, params.filter),
      start_(start),
      start_heading_rad_(start.heading_rad()) {}

void FusedPose::see(const PoseMeasurement& pose, std::optional<std::int64_t> stamp) noexcept {
  if (pose.tracker >= PoseFilter::kTrackers) return;
  if (stamp) {
    Stamps& stamps = stamps_[pose.tracker];
    const auto end = stamps.last.begin() + static_cast<std::ptrdiff_t>(std::min(stamps.count, stamps.last.size()));
    if (std::find(stamps.last.begin(), end, *stamp) != end) {
      ++doubled_;
      return;
    }
    stamps.last[stamps.count++ % stamps.last.size()] = *stamp;
  }
  by_true_clock_[pose.tracker] = pose.by_true_clock;
  auto& newest = seen_[pose.tracker];
  if (!newest || newest->taken_ns < pose.taken_ns) newest = pose;
  if (!newest_ || newest_->taken_ns < pose.taken_ns) newest_ = pose;
  if (pending_count_ == pending_.size()) {  // nobody latches: the newest ones count
    std::move(pending_.begin() + 1, pending_.end(), pending_.begin());
    --pending_count_;
    ++overrun_;
  }
  pending_[pending_count_++] = pose;
}

TrackedPose FusedPose::latch(const Moment& now) noexcept {
  read_wheels(now);
  note_sightings(now);
  for (std::size_t i = 0; i < pending_count_; ++i) take(pending_[i], now.monotonic_ns);
  pending_count_ = 0;
  judge(now.monotonic_ns);
  if (!found_) return {start_, 0, false};
  // The encoders may say where the body will only be.
  const std::optional<std::size_t> honest = honest_tracker();
  const auto lag_ns = static_cast<hal::TimeNs>(learnt().lag_s.value_or(0.0) * 1e9);
  const hal::TimeNs at_ns = std::min(filter_.time_ns() + lag_ns, now.monotonic_ns);
  const PoseEstimate estimate = honest ? filter_.seen_by(*honest, at_ns) : filter_.now();
  TrackedPose tracked{estimate.pose, honest ? at_ns : filter_.time_ns(), true};
  std::size_t n = 0;
  for (int i = 0; i < 3; ++i) {
    for (int j = 0; j <= i; ++j) tracked.covariance[n++] = estimate.covariance(i, j);
  }
  tracked.sd_m = std::sqrt(std::max(estimate.covariance(0, 0), estimate.covariance(1, 1)));
  tracked.sd_rad = std::sqrt(estimate.covariance(2, 2));
  tracked.vague = !(*tracked.sd_m <= params_.lost_m);
  return tracked;
}

void FusedPose::note_sightings(const Moment& now) noexcept {
  sightings_.count = 0;
  for (std::size_t i = 0; i < pending_count_; ++i) {
    if (sightings_.count == SightingsRow::kCapacity) {
      sightings_.lost += static_cast<std::uint32_t>(pending_count_ - i);
      return;
    }
    const PoseMeasurement& pose = pending_[i];
    const std::size_t at = sightings_.count++;
    sightings_.taken_ns[at] = now.to_run(pose.taken_ns);
    sightings_.x_m[at] = pose.x_m;
    sightings_.y_m[at] = pose.y_m;
    sightings_.heading_rad[at] = pose.heading_rad.value_or(std::numeric_limits<double>::quiet_NaN());
    sightings_.sd_m[at] = static_cast<float>(pose.sd_m);
    sightings_.sd_rad[at] = static_cast<float>(pose.sd_rad);
    sightings_.tracker[at] = pose.tracker;
    sightings_.true_clock[at] = pose.by_true_clock ? 1 : 0;
  }
}

void FusedPose::note_learnt(TrackRow& row) const noexcept {
  if (!found_) return;
  const PoseFilter::Learnt l = learnt();
  const auto set = [](float& value, float& sd, double found, double found_sd) {
    value = static_cast<float>(found);
    sd = static_cast<float>(found_sd);
  };
  set(row.left, row.left_sd, l.left, l.sd[0]);
  set(row.right, row.right_sd, l.right, l.sd[1]);
  set(row.base, row.base_sd, l.base, l.sd[2]);
  if (l.lag_s) set(row.lag_s, row.lag_sd_s, *l.lag_s, l.lag_sd_s);
}

void FusedPose::read_wheels(const Moment& now) noexcept {
  if (encoders_.validity == hal::Validity::Absent) return;
  const hal::TimeNs taken_ns = now.to_monotonic(encoders_.taken_ns);
  if (taken_ns > now.monotonic_ns) {
    if (encoders_.taken_ns != future_ns_) ++wheels_rejected_;
    future_ns_ = encoders_.taken_ns;
    return;
  }
  if (wheels_known_ && taken_ns <= wheels_at_ns_) return;
  double left_m = encoders_.left_m - left_m_, right_m = encoders_.right_m - right_m_;
  if (!std::isfinite(left_m) || !std::isfinite(right_m)) {
    ++wheels_rejected_;
    return;
  }
  if (!wheels_known_) {
    filter_.put(start_, taken_ns, kUnknown_m, kUnknown_rad);
    left_m = right_m = 0.0;
  }
  const double most_m = kSpeedMargin * max_speed_m_s_ * hal::to_seconds(taken_ns - wheels_at_ns_) + kStepMargin_m;
  const bool reset = wheels_known_ && (std::fabs(left_m) > most_m || std::fabs(right_m) > most_m);
  if (reset) ++wheels_rejected_;
  const double turn_rad_s = (right_m - left_m) / wheel_base_m_ / hal::to_seconds(taken_ns - wheels_at_ns_);
  unsteady_before_ = std::exchange(unsteady_rad_s_, std::fabs(turn_rad_s - (right_m_s_ - left_m_s_) / wheel_base_m_));
  double gyroscope_sd_rad = 0.0;
  const std::optional<double> turn_rad = turned_rad(taken_ns - wheels_at_ns_, gyroscope_sd_rad);
  // Read now and then it sees little of how the wheels slip in between.
  gyroscope_sd_rad = std::hypot(gyroscope_sd_rad, kUnseenSlip * params_.filter.wheel_noise_m / wheel_base_m_ *
                                                      std::sqrt(std::fabs(left_m) + std::fabs(right_m)));
  if (reset || way_lost_)
    filter_.roll(taken_ns, 0.0, 0.0);
  else
    roll(taken_ns, left_m, right_m, turn_rad, gyroscope_sd_rad);
  way_lost_ = false;
  left_m_ = encoders_.left_m;
  right_m_ = encoders_.right_m;
  wheels_at_ns_ = taken_ns;
  wheels_known_ = true;
}

/// Between two readings wheels roll as they were told, as late as they obey; what the reading says besides is spread
/// evenly. While that is not known, a change of speed may have been anywhere between.
void FusedPose::roll(hal::TimeNs until_ns, double left_m, double right_m, std::optional<double> turn_rad,
                     double sd_rad) noexcept {
  constexpr std::size_t kMost = 8;
  struct Piece {
    double left_m, right_m, s;
  };
  std::array<Piece, kMost> pieces;
  std::size_t count = 0;
  const double span_s = hal::to_seconds(until_ns - wheels_at_ns_);
  const double left_m_s = left_m / span_s, right_m_s = right_m / span_s;
  double told_left_m = 0.0, told_right_m = 0.0;
  const DelayEstimate late = motion_ != nullptr ? motion_->to_counters() : DelayEstimate{};
  if (late.told) {
    motion_->each(wheels_at_ns_, until_ns, late.value_s, [&](double l, double r, double s) {
      if (count < kMost) pieces[count] = {l * s, r * s, s};
      ++count;
      told_left_m += l * s;
      told_right_m += r * s;
    });
  }
  const double off = std::fabs(left_m - told_left_m) + std::fabs(right_m - told_right_m);
  const double changed_m = (std::fabs(left_m_s - left_m_s_) + std::fabs(right_m_s - right_m_s_)) * span_s;
  const bool as_told = count > 0 && count <= kMost && off < 0.5 * changed_m + kStepMargin_m;
  UnevenWay uneven;
  if (!as_told) {
    uneven.way_m = 0.5 * std::fabs(left_m_s + right_m_s - left_m_s_ - right_m_s_) * span_s;
    uneven.turn_rad = std::fabs(right_m_s - left_m_s - right_m_s_ + left_m_s_) * span_s / wheel_base_m_;
    pieces[0] = {left_m, right_m, span_s};
    count = 1;
    told_left_m = left_m;
    told_right_m = right_m;
  }
  left_m_s_ = left_m_s;
  right_m_s_ = right_m_s;
  double at_s = 0.0;
  for (std::size_t i = 0; i < count; ++i) {
    const Piece& p = pieces[i];
    const double part = p.s / span_s;
    at_s += p.s;
    const double l = p.left_m + part * (left_m - told_left_m), r = p.right_m + part * (right_m - told_right_m);
    const hal::TimeNs to_ns =
        i + 1 == count ? until_ns : wheels_at_ns_ + static_cast<hal::TimeNs>(std::llround(at_s * 1e9));
    std::optional<double> turn;
    if (turn_rad) turn = (r - l) / wheel_base_m_ + part * (*turn_rad - (right_m - left_m) / wheel_base_m_);
    filter_.roll(to_ns, l, r, turn, sd_rad * std::sqrt(part), uneven);
  }
}

/// By the gyroscope, since the last reading of the wheels: the mean of the rates at both ends, which is wrong by up to
/// half of their difference, and of another moment where the body lags the wheels. Nothing while the turn changes fast.
std::optional<double> FusedPose::turned_rad(hal::TimeNs span_ns, double& sd_rad) noexcept {
  const std::optional<double> before = rate_rad_s_;
  rate_rad_s_.reset();
  if (gyroscope_ == nullptr || gyroscope_->validity != hal::Validity::Fresh) return {};
  const hal::TimeNs apart_ns = gyroscope_->taken_ns - encoders_.taken_ns;
  if (apart_ns > kGyroscopeFits_ns || apart_ns < -kGyroscopeFits_ns || !std::isfinite(gyroscope_->rate_rad_s[2]))
    return {};
  rate_rad_s_ = static_cast<double>(gyroscope_->rate_rad_s[2]);
  if (!before || !wheels_known_) return {};
  const double span_s = hal::to_seconds(span_ns);
  const double changed_rad_s = std::fabs(*rate_rad_s_ - *before);
  const double unsteady_rad_s = std::max({changed_rad_s, unsteady_rad_s_, unsteady_before_});
  if (unsteady_rad_s > kSteady_rad_s) return {};
  const double lag_s = std::fabs(learnt().lag_s.value_or(params_.filter.delay_s));
  sd_rad = 0.5 * changed_rad_s * span_s + unsteady_rad_s * lag_s;
  return 0.5 * (*rate_rad_s_ + *before) * span_s;
}

/// Whether `pose` and those before it are of one place, kFound in a row.
bool FusedPose::agree(const PoseMeasurement& pose) noexcept {
  const bool fits = candidate_ &&
                    std::hypot(pose.x_m - candidate_->x_m, pose.y_m - candidate_->y_m) <=
                        kAgree_m + 3.0 * (pose.sd_m + candidate_->sd_m) &&
                    (!pose.heading_rad || !candidate_->heading_rad ||
                     std::fabs(hal::wrapped(*pose.heading_rad - *candidate_->heading_rad)) <=
                         kAgree_rad + 3.0 * (pose.sd_rad + candidate_->sd_rad));
  agreed_ = fits ? agreed_ + 1 : 1;
  const bool tells_more = !candidate_ || pose.heading_rad || !candidate_->heading_rad;
  if (!fits || tells_more) candidate_ = pose;
  return agreed_ >= kFound;
}

void FusedPose::put(const PoseMeasurement& pose) noexcept {
  const core::Pose before = filter_.now().pose;
  const double guess_rad = found_ ? before.heading_rad() : start_heading_rad_;
  filter_.put(core::Pose::at(pose.x_m, pose.y_m, pose.heading_rad.value_or(guess_rad), start_.z_m), pose.taken_ns,
              0.01 + pose.sd_m, pose.heading_rad ? 0.05 + pose.sd_rad : kGuess_rad);
  candidate_.reset();
  agreed_ = 0;
}

void FusedPose::take(const PoseMeasurement& pose, hal::TimeNs now_ns) noexcept {
  if (!wheels_known_) return;
  if (!found_) {
    if (!agree(pose)) return;
    put(*candidate_);
    found_ = true;
    return;
  }
  if (now_ns - wheels_at_ns_ <= kBlind_ns) {
    if (filter_.correct(pose) == PoseFilter::Taken::Nonsense) ++impossible_;
    return;
  }
  // The wheels are silent: what trackers agree on is where it is.
  if (pose.taken_ns <= filter_.time_ns() || !agree(pose)) return;
  const core::Pose before = filter_.now().pose;
  const double most_m = kSpeedMargin * max_speed_m_s_ * hal::to_seconds(pose.taken_ns - wheels_at_ns_) + kAgree_m;
  if (std::hypot(pose.x_m - before.x_m, pose.y_m - before.y_m) > most_m) ++found_elsewhere_;
  put(*candidate_);
  way_lost_ = true;
}

/// Disputes last a while.
void FusedPose::judge(hal::TimeNs now_ns) noexcept {
  if (filter_.disputed() != disputes_) {
    disputes_ = filter_.disputed();
    disputed_at_ns_ = now_ns;
    disputed_ = true;
  }
  if (disputed_ && now_ns - disputed_at_ns_ > kDisputed_ns) disputed_ = false;
}

/// The tracker with right stamps whose delay behind the encoders is known best; nothing: none, or not well enough.
std::optional<std::size_t> FusedPose::honest_tracker() const noexcept {
  const PoseFilter::Learnt learnt = filter_.learnt();
  std::optional<std::size_t> best;
  for (std::size_t i = 0; i < PoseFilter::kTrackers; ++i) {
    const bool known = by_true_clock_[i] && learnt.sd[4 + i] < kDelayKnown_s;
    if (known && (!best || learnt.sd[4 + i] < learnt.sd[4 + *best])) best = i;
  }
  return best;
}

PoseFilter::Learnt FusedPose::learnt() const noexcept {
  PoseFilter::Learnt learnt = filter_.learnt();
  const std::optional<std::size_t> honest = honest_tracker();
  if (!honest) return learnt;
  const double later_s = learnt.delay_s[*honest];
  learnt.lag_s = seen_later(later_s, true).lag_s;
  learnt.lag_sd_s = learnt.sd[4 + *honest];
  for (std::size_t i = 0; i < PoseFilter::kTrackers; ++i) {
    const SeenLater whose = seen_later(learnt.delay_s[i], by_true_clock_[i]);
    learnt.delay_s[i] = by_true_clock_[i] ? whose.tracker_s : whose.tracker_s - *learnt.lag_s;
  }
  return learnt;
}

std::uint64_t FusedPose::rejected() const noexcept {
  const PoseCounts c = counts();
  return c.gated + c.late + c.doubled + c.impossible + wheels_rejected_;
}

PoseCounts FusedPose::counts() const noexcept {
  return {filter_.used(), filter_.gated(), filter_.too_late() + overrun_, doubled_, impossible_, filter_.disputed(),
          jumps(),        slips()};
}

}  // namespace tandem::mixed_reality
