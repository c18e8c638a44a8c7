#include "mixed_reality/tracking/pose_filter.hpp"

#include <Eigen/LU>
#include <algorithm>
#include <cmath>
#include <numbers>

#include "hal/angle.hpp"
#include "mixed_reality/tracking/odometry.hpp"

namespace tandem::mixed_reality {
namespace {

constexpr double kGate2 = 13.816, kGate3 = 16.266;    // chi-squared of 2 and 3 degrees, 0.999
constexpr double kAgree_m = 0.05;                     // gated poses agree when they differ by this and their noise
constexpr double kReach_m = 0.03, kReach_rad = 0.15;  // beyond what wheels rolled, and noise: it was moved
constexpr double kScaleWander = 1e-5;                 // of the scales, after one metre: tyres and floors differ
constexpr double kMostLearnt = 5.0;                   // standard deviations of what was assumed

hal::TimeNs to_ns(double seconds) noexcept {
  return static_cast<hal::TimeNs>(std::llround(seconds * 1e9));
}

bool sound(const PoseMeasurement& m) noexcept {
  return m.tracker < PoseFilter::kTrackers && std::isfinite(m.x_m) && std::isfinite(m.y_m) &&
         std::isfinite(m.heading_rad.value_or(0.0)) && m.sd_m > 0.0 && m.sd_rad > 0.0 && std::isfinite(m.sd_m) &&
         std::isfinite(m.sd_rad);
}

}  // namespace

void PoseFilter::State::add(const Errors& e, const PoseFilterParams& assumed) noexcept {
  const auto near = [](double value, double middle, double sd) {
    return std::clamp(value, middle - kMostLearnt * sd, middle + kMostLearnt * sd);
  };
  pose = core::Pose::at(pose.x_m + e[0], pose.y_m + e[1], pose.heading_rad() + e[2], pose.z_m);
  left = near(left + e[3], 1.0, assumed.scale);
  right = near(right + e[4], 1.0, assumed.scale);
  base = near(base + e[5], 1.0, assumed.base);
  bias_rad_s = near(bias_rad_s + e[6], 0.0, assumed.bias_rad_s);
  for (std::size_t i = 0; i < kTrackers; ++i)
    delay_s[i] = near(delay_s[i] + e[kDelay + static_cast<int>(i)], 0.0, assumed.delay_s);
}

PoseFilter::PoseFilter(const core::Pose& start, hal::TimeNs start_ns, double sd_m, double sd_rad, double wheel_base_m,
                       const PoseFilterParams& params)
    : wheel_base_m_(wheel_base_m), params_(params) {
  Event begin;
  begin.time_ns = start_ns;
  begin.after.pose = start;
  const double scale = params.scale, base = params.base;
  begin.after.p.diagonal().setConstant(params.delay_s * params.delay_s);
  begin.after.p.diagonal().head<kDelay>() << sd_m * sd_m, sd_m * sd_m, sd_rad * sd_rad, scale * scale, scale * scale,
      base * base, params.bias_rad_s * params.bias_rad_s;
  append(begin);
}

// --- the ring of events ---

void PoseFilter::append(const Event& e) noexcept {
  if (count_ == kKept) {
    first_ = (first_ + 1) % kKept;
    --count_;
  }
  event(count_++) = e;
}

/// Between others; the oldest goes where there is no room. False: that would be its own place.
bool PoseFilter::insert(std::size_t at, const Event& e) noexcept {
  if (count_ == kKept) {
    if (at <= 1) return false;
    first_ = (first_ + 1) % kKept;
    --count_;
    --at;
  }
  for (std::size_t i = count_; i > at; --i) event(i) = event(i - 1);
  event(at) = e;
  ++count_;
  return true;
}

/// Computes the states anew from this event on. What was used before is used again: it is not gated twice.
void PoseFilter::repeat(std::size_t from) noexcept {
  for (std::size_t i = from; i < count_; ++i) {
    Event& e = event(i);
    const double dt_s = hal::to_seconds(e.time_ns - event(i - 1).time_ns);
    e.after = event(i - 1).after;
    step(e.after, e, dt_s);
    if (!e.measured) continue;
    const double per_s = dt_s > 0.0 ? 1.0 / dt_s : 0.0;
    (void)update(e.after, *e.measured, e.delay_s, e.left_m * per_s, e.right_m * per_s, false);
  }
}

// --- prediction ---

void PoseFilter::step(State& s, const Event& e, double dt_s) const noexcept {
  const double left_m = e.left_m * s.left, right_m = e.right_m * s.right, base_m = wheel_base_m_ * s.base;
  const double way_m = 0.5 * (left_m + right_m);
  const double by_wheels_rad = (right_m - left_m) / base_m;
  const double noise2 = params_.wheel_noise_m * params_.wheel_noise_m;
  const double left_var = noise2 * std::fabs(left_m), right_var = noise2 * std::fabs(right_m);
  const double wheels_var = (left_var + right_var) / (base_m * base_m);

  // The turn by wheels, as it depends on left, right, base.
  Eigen::Matrix<double, 1, kErrors> turn_by = Eigen::Matrix<double, 1, kErrors>::Zero();
  turn_by(3) = -e.left_m / base_m;
  turn_by(4) = e.right_m / base_m;
  turn_by(5) = -by_wheels_rad / s.base;
  double turn_rad = by_wheels_rad, turn_var = wheels_var, wheels_part = 1.0;
  if (e.gyroscope_rad && dt_s > 0.0) {
    // Both tell the turn: their mean by weight, whose noise knows nothing of their difference; and the difference tells
    // of the bias and of the wheels.
    const double gyroscope_var = params_.gyroscope_rad_s * params_.gyroscope_rad_s * dt_s + e.gyroscope_var;
    Eigen::Matrix<double, 1, kErrors> h = turn_by;
    h(6) = dt_s;
    const double r = *e.gyroscope_rad - s.bias_rad_s * dt_s - by_wheels_rad;
    const Errors ph = s.p * h.transpose();
    const double var = (h * ph)(0) + wheels_var + gyroscope_var;
    s.p -= ph * ph.transpose() / var;
    s.add(ph * (r / var), params_);
    wheels_part = wheels_var + gyroscope_var > 0.0 ? gyroscope_var / (wheels_var + gyroscope_var) : 1.0;
    const double learnt_rad = (e.right_m * s.right - e.left_m * s.left) / (wheel_base_m_ * s.base);
    turn_rad = wheels_part * learnt_rad + (1.0 - wheels_part) * (*e.gyroscope_rad - s.bias_rad_s * dt_s);
    turn_var = wheels_part * wheels_part * wheels_var + (1.0 - wheels_part) * (1.0 - wheels_part) * gyroscope_var;
    turn_by *= wheels_part;
    turn_by(6) = -(1.0 - wheels_part) * dt_s;
  }

  const core::Pose before = s.pose;
  s.pose = rolled(before, way_m - 0.5 * turn_rad, way_m + 0.5 * turn_rad, 1.0);
  const double middle_rad = before.heading_rad() + 0.5 * turn_rad;
  const double c = std::cos(middle_rad), sn = std::sin(middle_rad);

  Covariance f = Covariance::Identity();
  f(0, 2) = -(s.pose.y_m - before.y_m);
  f(1, 2) = s.pose.x_m - before.x_m;
  Eigen::Matrix<double, 1, kErrors> way_by = Eigen::Matrix<double, 1, kErrors>::Zero();
  way_by(3) = 0.5 * e.left_m;
  way_by(4) = 0.5 * e.right_m;
  f.row(0) += c * way_by - 0.5 * way_m * sn * turn_by;
  f.row(1) += sn * way_by + 0.5 * way_m * c * turn_by;
  f.row(2) += turn_by;
  s.p = (f * s.p * f.transpose()).eval();

  // Noise of the way and of the turn; both hold the wheels' noise, with the part that the wheels have in the turn.
  const double way_var = 0.25 * (left_var + right_var);
  const double both = wheels_part * 0.5 * (right_var - left_var) / base_m;
  Eigen::Matrix<double, 3, 2> g;
  g << c, -0.5 * way_m * sn, sn, 0.5 * way_m * c, 0.0, 1.0;
  Eigen::Matrix2d q;
  q << way_var, both, both, turn_var;
  s.p.topLeftCorner<3, 3>() += g * q * g.transpose();
  const double wander = kScaleWander * kScaleWander * (std::fabs(left_m) + std::fabs(right_m));
  s.p(3, 3) += wander;
  s.p(4, 4) += wander;
  s.p(5, 5) += wander;
  s.p(6, 6) += params_.bias_drift_rad_s * params_.bias_drift_rad_s * dt_s;
}

void PoseFilter::roll(hal::TimeNs taken_ns, double left_m, double right_m, std::optional<double> gyroscope_rad,
                      double gyroscope_sd_rad, const UnevenWay& uneven) noexcept {
  const Event& last = event(count_ - 1);
  if (taken_ns <= last.time_ns || !std::isfinite(left_m) || !std::isfinite(right_m)) return;
  rolled_left_m_ += std::fabs(left_m);
  rolled_right_m_ += std::fabs(right_m);
  Event e;
  e.time_ns = taken_ns;
  e.left_m = left_m;
  e.right_m = right_m;
  if (gyroscope_rad && std::isfinite(*gyroscope_rad)) e.gyroscope_rad = gyroscope_rad;
  e.gyroscope_var = gyroscope_sd_rad * gyroscope_sd_rad;
  e.uneven = uneven;
  append(e);
  repeat(count_ - 1);
  take_waiting();
}

// --- correction ---

bool PoseFilter::update(State& s, const PoseMeasurement& m, double delay_s, double left_m_s, double right_m_s,
                        bool gate) noexcept {
  const int n = m.heading_rad ? 3 : 2;
  const double way_m_s = 0.5 * (left_m_s * s.left + right_m_s * s.right);
  const double turn_rad_s = (right_m_s * s.right - left_m_s * s.left) / (wheel_base_m_ * s.base);
  Eigen::Matrix<double, 3, kErrors> h = Eigen::Matrix<double, 3, kErrors>::Zero();
  h.leftCols<3>().setIdentity();
  const int delay = kDelay + m.tracker;
  h(0, delay) = -way_m_s * s.pose.cos_h;  // taken `delay` before its stamp, and the robot has driven on
  h(1, delay) = -way_m_s * s.pose.sin_h;
  h(2, delay) = -turn_rad_s;
  // The event stands where the delay was believed to be when it came; this state may believe another.
  const double later_s = s.delay_s[m.tracker] - delay_s;
  const Eigen::Vector3d expected =
      Eigen::Vector3d(s.pose.x_m, s.pose.y_m, s.pose.heading_rad()) + later_s * h.col(delay);
  Eigen::Vector3d r(m.x_m - expected[0], m.y_m - expected[1],
                    m.heading_rad ? hal::wrapped(*m.heading_rad - expected[2]) : 0.0);
  Eigen::Matrix3d noise = Eigen::Matrix3d::Zero();
  noise.diagonal() << m.sd_m * m.sd_m, m.sd_m * m.sd_m, m.sd_rad * m.sd_rad;
  if (n == 2) {
    h.row(2).setZero();
    noise(2, 2) = 1.0;
  }
  const Eigen::Matrix<double, kErrors, 3> ph = s.p * h.transpose();
  const Eigen::Matrix3d innovation = h * ph + noise;
  const Eigen::Matrix3d inverse = innovation.inverse();
  const double distance = r.dot(inverse * r);
  if (gate) {
    innovation_ = distance;
    if (!(distance <= (n == 3 ? kGate3 : kGate2))) return false;
  }
  const Eigen::Matrix<double, kErrors, 3> gain = ph * inverse;
  // Joseph's form keeps the covariance symmetric and positive.
  const Covariance rest = Covariance::Identity() - gain * h;
  s.p = (rest * s.p * rest.transpose() + gain * noise * gain.transpose()).eval();
  s.add(gain * r, params_);
  return true;
}

hal::TimeNs PoseFilter::time_of(const PoseMeasurement& m) const noexcept {
  return m.taken_ns - to_ns(event(count_ - 1).after.delay_s[m.tracker]);
}

PoseFilter::Taken PoseFilter::correct(const PoseMeasurement& m) noexcept {
  if (!sound(m)) return Taken::Nonsense;
  if (time_of(m) <= event(count_ - 1).time_ns) return take(m);
  if (waiting_count_ == waiting_.size()) {
    std::move(waiting_.begin() + 1, waiting_.end(), waiting_.begin());
    --waiting_count_;
  }
  waiting_[waiting_count_++] = m;
  return Taken::Waits;
}

void PoseFilter::take_waiting() noexcept {
  std::size_t kept = 0;
  const std::size_t all = waiting_count_;
  waiting_count_ = 0;
  for (std::size_t i = 0; i < all; ++i) {
    const PoseMeasurement m = waiting_[i];
    if (time_of(m) <= event(count_ - 1).time_ns)
      (void)take(m);
    else
      waiting_[kept++] = m;
  }
  waiting_count_ = kept;
}

PoseFilter::Taken PoseFilter::take(const PoseMeasurement& m) noexcept {
  const hal::TimeNs at_ns = time_of(m);
  std::size_t next = count_;
  while (next > 0 && event(next - 1).time_ns >= at_ns) --next;
  if (next == 0 || (next == 1 && count_ == kKept)) {
    ++too_late_;
    return Taken::TooLate;
  }
  // The stretch that ends with event `next` is parted where the pose was taken.
  const Event& whole = event(next);
  const double stretch_s = hal::to_seconds(whole.time_ns - event(next - 1).time_ns);
  const double part = stretch_s > 0.0 ? hal::to_seconds(at_ns - event(next - 1).time_ns) / stretch_s : 1.0;
  Event e;
  e.time_ns = at_ns;
  e.left_m = part * whole.left_m;
  e.right_m = part * whole.right_m;
  if (whole.gyroscope_rad) e.gyroscope_rad = part * *whole.gyroscope_rad;
  e.gyroscope_var = part * whole.gyroscope_var;
  e.measured = m;
  e.measured->sd_m = std::hypot(m.sd_m, whole.uneven.way_m * part);
  e.measured->sd_rad = std::hypot(m.sd_rad, whole.uneven.turn_rad * part);
  e.delay_s = event(count_ - 1).after.delay_s[m.tracker];
  e.after = event(next - 1).after;
  const double per_s = stretch_s > 0.0 ? 1.0 / stretch_s : 0.0;
  step(e.after, e, part * stretch_s);
  if (!update(e.after, *e.measured, e.delay_s, whole.left_m * per_s, whole.right_m * per_s, true)) return gate_out(m);
  odd_[m.tracker].count = 0;
  believed_[m.tracker] = {m, rolled_left_m_, rolled_right_m_};
  used_at_ns_[m.tracker] = any_used_[m.tracker] ? std::max(used_at_ns_[m.tracker], at_ns) : at_ns;
  any_used_[m.tracker] = true;
  Event rest = whole;
  rest.left_m -= e.left_m;
  rest.right_m -= e.right_m;
  if (rest.gyroscope_rad) *rest.gyroscope_rad -= *e.gyroscope_rad;
  rest.gyroscope_var -= e.gyroscope_var;
  event(next) = rest;
  if (!insert(next, e)) {
    event(next) = whole;
    ++too_late_;
    return Taken::TooLate;
  }
  std::size_t from = 0;
  while (event(from).time_ns != at_ns || !event(from).measured) ++from;
  repeat(from + 1);
  ++used_;
  return Taken::Used;
}

/// Counts poses that nobody expected. Those of one tracker that agree with one another, as far as the wheels rolled
/// between them, are believed in the end, unless another tracker was believed meanwhile.
PoseFilter::Taken PoseFilter::gate_out(const PoseMeasurement& m) noexcept {
  ++gated_;
  const core::Pose at = now().pose;
  Odd& odd = odd_[m.tracker];
  bool agrees = false;
  if (odd.count > 0) {
    const double rolled_m = std::hypot(at.x_m - odd.at.x_m, at.y_m - odd.at.y_m);
    const double apart_m = std::hypot(m.x_m - odd.last.x_m, m.y_m - odd.last.y_m);
    agrees = std::fabs(apart_m - rolled_m) <= kAgree_m + 4.0 * (m.sd_m + odd.last.sd_m);
  }
  if (!agrees) odd.since_ns = m.taken_ns;
  odd.alike =
      !agrees || (odd.alike && m.x_m == odd.last.x_m && m.y_m == odd.last.y_m && m.heading_rad == odd.last.heading_rad);
  odd.count = agrees ? std::min(odd.count + 1, kInsists) : 1;
  odd.last = m;
  odd.at = at;
  if (odd.count < kInsists || hal::to_seconds(m.taken_ns - odd.since_ns) < kInsists_s) return Taken::Gated;
  for (std::size_t other = 0; other < kTrackers; ++other) {
    const double ago_s = hal::to_seconds(time_of(m) - used_at_ns_[other]);
    if (other == m.tracker || !any_used_[other] || ago_s > kOthers_s) continue;
    ++disputed_;
    return Taken::Disputed;
  }
  // A picture that stands still to the last bit shows no robot that is held fast: it shows nothing.
  const bool slipped = within_reach(m) && !odd.alike;
  carry_to(m);
  believed_[m.tracker] = {m, rolled_left_m_, rolled_right_m_};
  slipped ? ++slipped_ : ++moved_;
  return slipped ? Taken::Slipped : Taken::Moved;
}

/// Whether the wheels can have brought it there, since its tracker was last believed: however they slipped.
bool PoseFilter::within_reach(const PoseMeasurement& m) const noexcept {
  const Believed& from = believed_[m.tracker];
  if (!any_used_[m.tracker]) return false;
  const double left_m = rolled_left_m_ - from.left_m, right_m = rolled_right_m_ - from.right_m;
  const double came_m = std::hypot(m.x_m - from.pose.x_m, m.y_m - from.pose.y_m);
  if (came_m > std::max(left_m, right_m) + kReach_m + 4.0 * (m.sd_m + from.pose.sd_m)) return false;
  if (!m.heading_rad || !from.pose.heading_rad) return true;
  const double turned_rad = std::fabs(hal::wrapped(*m.heading_rad - *from.pose.heading_rad));
  return turned_rad <= (left_m + right_m) / wheel_base_m_ + kReach_rad + 4.0 * (m.sd_rad + from.pose.sd_rad);
}

/// Begins anew with `m`, carried on to the newest event by what was rolled since it was taken.
void PoseFilter::carry_to(const PoseMeasurement& m) noexcept {
  const core::Pose newest = now().pose;
  const hal::TimeNs at_ns = time_of(m);
  std::size_t then = count_ - 1;
  while (then > 0 && event(then).time_ns > at_ns) --then;
  const core::Pose old = event(then).after.pose;
  const double x_m = newest.x_m - old.x_m, y_m = newest.y_m - old.y_m;
  // In the frame of the robot as it was then, and from there to how it stands by `m`.
  const double ahead_m = x_m * old.cos_h + y_m * old.sin_h, left_m = y_m * old.cos_h - x_m * old.sin_h;
  const double turned_rad = newest.heading_rad() - old.heading_rad();
  const double heading_rad = m.heading_rad.value_or(old.heading_rad());
  const double c = std::cos(heading_rad), sn = std::sin(heading_rad);
  put(core::Pose::at(m.x_m + c * ahead_m - sn * left_m, m.y_m + sn * ahead_m + c * left_m, heading_rad + turned_rad,
                     newest.z_m),
      event(count_ - 1).time_ns, 0.02 + m.sd_m, m.heading_rad ? 0.05 + m.sd_rad : std::numbers::pi);
}

void PoseFilter::put(const core::Pose& pose, hal::TimeNs at_ns, double sd_m, double sd_rad) noexcept {
  Event e = event(count_ - 1);
  e.time_ns = std::max(at_ns, e.time_ns);
  e.left_m = e.right_m = 0.0;
  e.gyroscope_rad.reset();
  e.gyroscope_var = 0.0;
  e.measured.reset();
  e.after.pose = pose;
  e.after.p.topRows<3>().setZero();
  e.after.p.leftCols<3>().setZero();
  e.after.p(0, 0) = e.after.p(1, 1) = sd_m * sd_m;
  e.after.p(2, 2) = sd_rad * sd_rad;
  first_ = count_ = 0;
  append(e);
  for (Odd& odd : odd_) odd.count = 0;
}

// --- what is known ---

PoseEstimate PoseFilter::now() const noexcept {
  const State& s = event(count_ - 1).after;
  return {s.pose, s.p.topLeftCorner<3, 3>()};
}

/// The state then, by the stretch that holds it or, later than the newest, by the last whole one; and its speeds as the
/// encoders tell them.
PoseFilter::State PoseFilter::state_at(hal::TimeNs time_ns, double& left_m_s, double& right_m_s) const noexcept {
  std::size_t base = count_ - 1;  // the last event that is not later
  while (base > 0 && event(base).time_ns > time_ns) --base;
  // The whole stretch behind it, whatever poses part it.
  std::size_t end = std::min(base + 1, count_ - 1);
  while (end + 1 < count_ && event(end).measured) ++end;
  std::size_t begin = end;
  double left_m = 0.0, right_m = 0.0;
  do {
    left_m += event(begin).left_m;
    right_m += event(begin).right_m;
    if (begin == 0) break;
    --begin;
  } while (begin > 0 && event(begin).measured);
  const double stretch_s = hal::to_seconds(event(end).time_ns - event(begin).time_ns);
  left_m_s = stretch_s > 0.0 ? left_m / stretch_s : 0.0;
  right_m_s = stretch_s > 0.0 ? right_m / stretch_s : 0.0;
  State s = event(base).after;
  const double for_s = hal::to_seconds(time_ns - event(base).time_ns);
  if (count_ < 2 || for_s <= 0.0 || stretch_s <= 0.0) return s;
  Event on;
  on.left_m = left_m_s * for_s;
  on.right_m = right_m_s * for_s;
  step(s, on, for_s);
  return s;
}

PoseEstimate PoseFilter::at(hal::TimeNs time_ns) const noexcept {
  double left_m_s = 0.0, right_m_s = 0.0;
  const State s = state_at(time_ns, left_m_s, right_m_s);
  return {s.pose, s.p.topLeftCorner<3, 3>()};
}

PoseEstimate PoseFilter::seen_by(std::size_t tracker, hal::TimeNs time_ns) const noexcept {
  double left_m_s = 0.0, right_m_s = 0.0;
  const State s = state_at(time_ns - to_ns(event(count_ - 1).after.delay_s[tracker]), left_m_s, right_m_s);
  // A delay that is longer by d puts the pose as it is stamped d of driving back.
  Eigen::Matrix<double, 3, kErrors> h = Eigen::Matrix<double, 3, kErrors>::Zero();
  h.leftCols<3>().setIdentity();
  const double way_m_s = 0.5 * (left_m_s * s.left + right_m_s * s.right);
  const int delay = kDelay + static_cast<int>(tracker);
  h(0, delay) = -way_m_s * s.pose.cos_h;
  h(1, delay) = -way_m_s * s.pose.sin_h;
  h(2, delay) = -(right_m_s * s.right - left_m_s * s.left) / (wheel_base_m_ * s.base);
  return {s.pose, h * s.p * h.transpose()};
}

PoseFilter::Learnt PoseFilter::learnt() const noexcept {
  const State& s = event(count_ - 1).after;
  Learnt learnt{s.left, s.right, s.base, s.bias_rad_s, s.delay_s, {}};
  for (int i = 0; i < kErrors - 3; ++i)
    learnt.sd[static_cast<std::size_t>(i)] = std::sqrt(std::max(0.0, s.p(3 + i, 3 + i)));
  return learnt;
}

}  // namespace tandem::mixed_reality
