#include "mixed_reality/gap/wheel_fit.hpp"

#include <Eigen/Core>
#include <Eigen/Dense>
#include <algorithm>
#include <array>
#include <cmath>
#include <limits>

#include "hal/angle.hpp"

namespace tandem::mixed_reality {
namespace {

using Eigen::Matrix3d;
using Eigen::Vector3d;

// The parameters, in this order; play in m. Those of noise are logarithms.
enum Param : int { kLeft, kRight, kBase, kDelay, kMount, kPlay, kNoise, kPoseM, kPoseRad, kParams };
using Params = Eigen::Matrix<double, kParams, 1>;
using Information = Eigen::Matrix<double, kParams, kParams>;

/// What is known of a parameter before: a deviation around its first value. Wide: it only holds fast what the data does
/// not tell.
const Params kPrior = (Params() << 0.3, 0.3, 0.3, 0.25, 0.5, 1e-3, 3.0, 2.0, 2.0).finished();
/// Steps of the numeric derivatives.
const Params kStep = (Params() << 1e-4, 1e-4, 1e-4, 1e-4, 1e-4, 1e-5, 1e-3, 1e-3, 1e-3).finished();
/// A parameter is told by the data when its error is below this part of what was known before.
constexpr double kTold = 0.4;
constexpr double kLongestDelay_s = 0.6;
constexpr double kOutlier = 16.3;     // chi square of three degrees of freedom, one in a thousand
constexpr double kElsewhere = 60.0;   // no noise explains it
constexpr double kStretch_s = 4.0;    // over which scores are added up for the errors
constexpr std::size_t kFewest = 30;   // ticks
constexpr double kSideways = 2.5e-7;  // variance in m^2 after 1 m: 0.5 mm
constexpr double kStanding_m_s = 1e-4;

/// The innovation at one tick, and its covariance.
struct Innovation {
  Vector3d e = Vector3d::Zero();
  Matrix3d s = Matrix3d::Identity();
  bool there = false;
};

struct Filter {
  const std::vector<RecordedTick>& ticks;
  double tick_s;
  double base_m;

  /// The command that holds `n` ticks before tick `t`; false: it was not recorded.
  bool told(std::ptrdiff_t t, double& left, double& right) const {
    if (t < 0) {
      left = right = 0.0;
      return true;
    }
    const RecordedTick& tick = ticks[static_cast<std::size_t>(t)];
    left = tick.told_left_m_s;
    right = tick.told_right_m_s;
    return tick.told && !tick.held;
  }

  /// What remains of a way when the gear has turned through its play.
  static double through_play(double way_m, double play_m, double& at_m) {
    const double moved_m = std::clamp(at_m + way_m, 0.0, std::max(0.0, play_m));
    const double rest_m = way_m - (moved_m - at_m);
    at_m = moved_m;
    return rest_m;
  }

  static void roll(double left_m, double right_m, double base_m, double noise, Vector3d& at, Matrix3d& p) {
    const double way = 0.5 * (left_m + right_m);
    const double turn = (right_m - left_m) / base_m;
    const double half = 0.5 * turn;
    const double chord = way * (std::fabs(half) < 1e-6 ? 1.0 - half * half / 6.0 : std::sin(half) / half);
    const double c = std::cos(at.z() + half), s = std::sin(at.z() + half);
    Matrix3d f = Matrix3d::Identity();
    f(0, 2) = -chord * s;
    f(1, 2) = chord * c;
    at += Vector3d(chord * c, chord * s, turn);
    // Ways of the wheels vary by themselves; sideways a little, too.
    Matrix3d g;
    const double a = 0.5, b = 1.0 / base_m;
    g << a * c + 0.5 * chord * s * b, a * c - 0.5 * chord * s * b, -s,  //
        a * s - 0.5 * chord * c * b, a * s + 0.5 * chord * c * b, c,    //
        -b, b, 0.0;
    const double q = noise * noise;
    const Vector3d variance(q * std::fabs(left_m) + 1e-14, q * std::fabs(right_m) + 1e-14,
                            kSideways * std::fabs(way) + 1e-14);
    p = f * p * f.transpose() + g * variance.asDiagonal() * g.transpose();
  }

  /// One pass over the series. `elsewhere[t]`: the pose of that tick has nothing to do with the one before.
  void run(const Params& v, const std::vector<char>& elsewhere, std::vector<Innovation>& out) const {
    const double delay = std::max(0.0, v[kDelay]) / tick_s;
    const auto whole = static_cast<std::ptrdiff_t>(delay);
    const double rest = delay - static_cast<double>(whole);
    const double base = base_m * v[kBase], noise = std::exp(v[kNoise]);
    const double sd_m = std::exp(v[kPoseM]), sd_rad = std::exp(v[kPoseRad]);
    const Matrix3d r = Vector3d(sd_m * sd_m, sd_m * sd_m, sd_rad * sd_rad).asDiagonal();
    Vector3d at = Vector3d::Zero();
    Matrix3d p = Matrix3d::Zero();
    bool known = false;
    double play_left = 0.0, play_right = 0.0;  // how far each gear is through its play
    const auto roll_for = [&](double left, double right, double s) {
      const double left_m = v[kLeft] * through_play(left * s, v[kPlay], play_left);
      const double right_m = v[kRight] * through_play(right * s, v[kPlay], play_right);
      roll(left_m, right_m, base, noise, at, p);
    };
    out.assign(ticks.size(), {});
    for (std::size_t t = 0; t < ticks.size(); ++t) {
      if (known) {
        double left = 0.0, right = 0.0;
        const auto before = static_cast<std::ptrdiff_t>(t) - 1 - whole;
        known = told(before - 1, left, right) || rest == 0.0;
        roll_for(left, right, rest * tick_s);
        known = told(before, left, right) && known;
        roll_for(left, right, (1.0 - rest) * tick_s);
      }
      const RecordedTick& tick = ticks[t];
      if (!tick.posed) continue;
      const Vector3d seen(tick.x_m, tick.y_m, tick.heading_rad - v[kMount]);
      if (!known || elsewhere[t] != 0) {
        at = seen;
        p = r;
        known = true;
        continue;
      }
      Innovation& i = out[t];
      i.e = seen - at;
      i.e.z() = hal::wrapped(i.e.z());
      i.s = p + r;
      i.there = true;
      const Matrix3d gain = p * i.s.inverse();
      at += gain * i.e;
      at.z() = hal::wrapped(at.z());
      p = (Matrix3d::Identity() - gain) * p;
      p = 0.5 * (p + p.transpose().eval());
    }
  }
};

double chi_square(const Innovation& i) {
  return i.e.dot(i.s.ldlt().solve(i.e));
}

/// Minus the logarithm of the likelihood, with outliers held down.
double cost(const std::vector<Innovation>& innovations) {
  double sum = 0.0;
  for (const Innovation& i : innovations) {
    if (i.there) sum += 0.5 * (std::log(i.s.determinant()) + std::min(chi_square(i), kOutlier));
  }
  return sum;
}

class Fit {
 public:
  Fit(const RecordedRobot& robot, double tick_s, double base_m)
      : filter_{robot.ticks, tick_s, base_m}, elsewhere_(robot.ticks.size(), 0) {}

  /// False: nothing moves, or there is too little of it.
  bool search() {
    start();
    filter_.run(v_, elsewhere_, now_);
    double cost_now = cost(now_) + prior_cost(v_);
    double damping = 1e-3;
    for (int round = 0; round < 60; ++round) {
      if (round == 4 || round == 12 || round == 25) {
        leave_out();
        filter_.run(v_, elsewhere_, now_);
        cost_now = cost(now_) + prior_cost(v_);
      }
      score();
      bool better = false;
      double gained = 0.0;
      for (int tries = 0; tries < 8 && !better; ++tries) {
        Information damped = information_;
        damped.diagonal() *= 1.0 + damping;
        Params step = damped.ldlt().solve(gradient_);
        for (int k = 0; k < kParams; ++k) step[k] = std::clamp(step[k], -0.5 * kPrior[k], 0.5 * kPrior[k]);
        Params next = v_ + step;
        for (const int k : {kLeft, kRight, kBase}) next[k] = std::clamp(next[k], 0.1, 10.0);
        next[kDelay] = std::clamp(next[kDelay], 0.0, kLongestDelay_s + 0.4);
        next[kPlay] = std::clamp(next[kPlay], 0.0, 0.01);
        filter_.run(next, elsewhere_, trial_);
        const double cost_next = cost(trial_) + prior_cost(next);
        better = cost_next < cost_now;
        if (better) {
          gained = cost_now - cost_next;
          v_ = next;
          cost_now = cost_next;
          now_.swap(trial_);
        }
        damping = better ? std::max(1e-9, damping * 0.2) : damping * 6.0;
      }
      if (round > 26 && (!better || gained < 1e-4)) break;
    }
    score();
    used_ =
        static_cast<std::size_t>(std::count_if(now_.begin(), now_.end(), [](const Innovation& i) { return i.there; }));
    return used_ >= kFewest;
  }

  std::size_t used() const noexcept { return used_; }
  std::size_t left_out() const noexcept {
    return static_cast<std::size_t>(std::count(elsewhere_.begin(), elsewhere_.end(), 1));
  }
  const Params& values() const noexcept { return v_; }

  /// Standard errors: of a true model, or, where they are larger, of one that need not be.
  Params errors() const {
    const Information inverse = information_.inverse();
    const Information honest = inverse * scatter_ * inverse;
    Params e;
    for (int k = 0; k < kParams; ++k) e[k] = std::sqrt(std::max({inverse(k, k), honest(k, k), 0.0}));
    return e;
  }

 private:
  double prior_cost(const Params& v) const { return 0.5 * ((v - first_).cwiseQuotient(kPrior)).squaredNorm(); }

  /// First values: the delay by trying, noise as trackers have it.
  void start() {
    first_ << 1.0, 1.0, 1.0, 0.0, 0.0, 0.0, std::log(0.005), std::log(0.003), std::log(0.02);
    v_ = first_;
    double best = std::numeric_limits<double>::infinity();
    for (double delay_s = 0.0; delay_s <= kLongestDelay_s; delay_s += std::clamp(0.5 * filter_.tick_s, 0.01, 0.05)) {
      Params tried = v_;
      tried[kDelay] = delay_s;
      filter_.run(tried, elsewhere_, trial_);
      const double c = cost(trial_);
      if (c >= best) continue;
      best = c;
      first_[kDelay] = delay_s;
    }
    v_ = first_;
  }

  void leave_out() {
    for (std::size_t t = 0; t < now_.size(); ++t) {
      if (now_[t].there && chi_square(now_[t]) > kElsewhere) elsewhere_[t] = 1;
    }
  }

  /// Gradient, information and scatter of the likelihood's logarithm at v_, whose innovations are in now_.
  void score() {
    const std::size_t n = now_.size();
    for (int k = 0; k < kParams; ++k) {
      const auto i = static_cast<std::size_t>(k);
      Params up = v_, down = v_;
      up[k] += kStep[k];
      down[k] = k == kDelay || k == kPlay ? std::max(0.0, v_[k] - kStep[k]) : v_[k] - kStep[k];
      filter_.run(up, elsewhere_, up_[i]);
      filter_.run(down, elsewhere_, down_[i]);
      per_step_[i] = 1.0 / (up[k] - down[k]);
    }
    gradient_.setZero();
    information_.setZero();
    scatter_.setZero();
    Params stretch = Params::Zero();
    const auto stretch_ticks = std::max<std::size_t>(1, static_cast<std::size_t>(kStretch_s / filter_.tick_s));
    for (std::size_t t = 0; t < n; ++t) {
      if (now_[t].there) stretch += score_of(t);
      if ((t + 1) % stretch_ticks == 0 || t + 1 == n) {
        scatter_ += stretch * stretch.transpose();
        stretch.setZero();
      }
    }
    for (int k = 0; k < kParams; ++k) {
      information_(k, k) += 1.0 / (kPrior[k] * kPrior[k]);
      gradient_[k] -= (v_[k] - first_[k]) / (kPrior[k] * kPrior[k]);
    }
  }

  Params score_of(std::size_t t) {
    const Innovation& i = now_[t];
    const Matrix3d inverse = i.s.inverse();
    const Vector3d w = inverse * i.e;
    const double chi = i.e.dot(w);
    const double weight = chi > kOutlier ? 0.0 : 1.0;
    std::array<Vector3d, kParams> de;
    std::array<Matrix3d, kParams> a;
    Params score;
    for (int k = 0; k < kParams; ++k) {
      const auto j = static_cast<std::size_t>(k);
      Vector3d d = up_[j][t].e - down_[j][t].e;
      d.z() = hal::wrapped(d.z());
      de[j] = d * per_step_[j];
      const Matrix3d ds = (up_[j][t].s - down_[j][t].s) * per_step_[j];
      a[j] = inverse * ds;
      score[k] = -0.5 * a[j].trace() + weight * (-w.dot(de[j]) + 0.5 * w.dot(ds * w));
    }
    for (int k = 0; k < kParams; ++k) {
      const auto x = static_cast<std::size_t>(k);
      for (int l = 0; l <= k; ++l) {
        const auto y = static_cast<std::size_t>(l);
        const double value = weight * de[x].dot(inverse * de[y]) + 0.5 * (a[x] * a[y]).trace();
        information_(k, l) += value;
        if (k != l) information_(l, k) += value;
      }
    }
    gradient_ += score;
    return score;
  }

  Filter filter_;
  std::vector<char> elsewhere_;
  Params v_, first_, gradient_;
  Information information_, scatter_;
  std::vector<Innovation> now_, trial_;
  std::array<std::vector<Innovation>, kParams> up_, down_;
  std::array<double, kParams> per_step_{};
  std::size_t used_ = 0;
};

/// What an encoder counts of the way commanded, by least squares over the ticks, with a delay of its own.
Estimate fit_counts(const std::vector<RecordedTick>& ticks, double tick_s, double RecordedTick::*counted,
                    double RecordedTick::*told) {
  const auto of_delay = [&](double delay_s, Estimate& found) {
    const auto whole = static_cast<std::size_t>(delay_s / tick_s);
    const double rest = delay_s / tick_s - static_cast<double>(whole);
    double xx = 0.0, xy = 0.0, yy = 0.0;
    std::size_t n = 0;
    for (std::size_t t = whole + 2; t < ticks.size(); ++t) {
      const RecordedTick &now = ticks[t], &before = ticks[t - 1];
      const RecordedTick &newer = ticks[t - 1 - whole], &older = ticks[t - 2 - whole];
      if (!now.counted || !before.counted || !newer.told || !older.told || newer.held || older.held) continue;
      const double x = ((1.0 - rest) * newer.*told + rest * older.*told) * tick_s;
      const double y = now.*counted - before.*counted;
      xx += x * x;
      xy += x * y;
      yy += y * y;
      ++n;
    }
    if (n < kFewest || xx < 1e-6) return std::numeric_limits<double>::infinity();
    found.value = xy / xx;
    const double residual = std::max(0.0, yy - xy * xy / xx);
    found.error = std::sqrt(residual / static_cast<double>(n - 1) / xx);
    found.observable = found.error < 0.1;
    return residual;
  };
  Estimate best{1.0, 0.3, false};
  double least = std::numeric_limits<double>::infinity();
  const double step_s = 0.1 * tick_s;
  for (double delay_s = 0.0; delay_s < kLongestDelay_s; delay_s += step_s) {
    Estimate found;
    const double residual = of_delay(delay_s, found);
    if (residual >= least) continue;
    least = residual;
    best = found;
  }
  return best;
}

Estimate slip_of(const Estimate& rolled, const Estimate& counted) {
  if (!rolled.observable || !counted.observable || std::fabs(counted.value) < 0.1) return {};
  const double ratio = rolled.value / counted.value;
  return {1.0 - ratio, ratio * std::hypot(rolled.error / rolled.value, counted.error / counted.value), true};
}

bool has_commands(const std::vector<RecordedTick>& ticks) {
  return std::any_of(ticks.begin(), ticks.end(), [](const RecordedTick& t) { return t.told; });
}
bool moves(const std::vector<RecordedTick>& ticks) {
  return std::any_of(ticks.begin(), ticks.end(), [](const RecordedTick& t) {
    return std::fabs(t.told_left_m_s) > kStanding_m_s || std::fabs(t.told_right_m_s) > kStanding_m_s;
  });
}

}  // namespace

hal::WheelModel WheelFit::values() const noexcept {
  return {left.value,          right.value,        base.value,   counted_left.value,
          counted_right.value, noise_sqrt_m.value, delay_s.value};
}

hal::WheelModel WheelFit::errors() const noexcept {
  return {left.error,          right.error,        base.error,   counted_left.error,
          counted_right.error, noise_sqrt_m.error, delay_s.error};
}

WheelFit fit_wheels(const RecordedRobot& robot, double tick_s, const WheelFitOptions& options) {
  WheelFit fit;
  if (!has_commands(robot.ticks)) {
    fit.flaw =
        "the record has no commands of its wheels; record them with <record inputs=\"true\"/> of real robots, <record "
        "ports=\"differential_steering\"/> of simulated ones";
    return fit;
  }
  if (!moves(robot.ticks)) {
    fit.flaw = "it was never told to move";
    return fit;
  }
  fit.counted_left = fit_counts(robot.ticks, tick_s, &RecordedTick::counted_left_m, &RecordedTick::told_left_m_s);
  fit.counted_right = fit_counts(robot.ticks, tick_s, &RecordedTick::counted_right_m, &RecordedTick::told_right_m_s);
  Fit search(robot, tick_s, options.wheel_base_m);
  if (!search.search()) {
    fit.flaw = "poses of fewer than " + std::to_string(kFewest) + " ticks follow from commands";
    return fit;
  }
  const Params v = search.values(), e = search.errors();
  const auto estimate = [&](Param k) { return Estimate{v[k], e[k], e[k] < kTold * kPrior[k]}; };
  fit.ticks = search.used();
  fit.left_out = search.left_out();
  fit.left = estimate(kLeft);
  fit.right = estimate(kRight);
  fit.base = estimate(kBase);
  fit.delay_s = estimate(kDelay);
  fit.mount_rad = estimate(kMount);
  fit.play_m = estimate(kPlay);
  fit.noise_sqrt_m = {std::exp(v[kNoise]), std::exp(v[kNoise]) * e[kNoise], e[kNoise] < 1.0};
  fit.pose_noise_m = std::exp(v[kPoseM]);
  fit.pose_noise_rad = std::exp(v[kPoseRad]);
  if (options.poses_by_wheels) {
    for (Estimate* told_by_trackers :
         {&fit.left, &fit.right, &fit.base, &fit.mount_rad, &fit.play_m, &fit.noise_sqrt_m})
      told_by_trackers->observable = false;
  }
  for (Estimate* of : {&fit.left, &fit.right, &fit.base}) {
    if (!of->observable) of->value = 1.0;
  }
  if (!fit.delay_s.observable) fit.delay_s.value = 0.0;
  if (!fit.noise_sqrt_m.observable) fit.noise_sqrt_m.value = 0.0;
  if (!fit.counted_left.observable) fit.counted_left.value = fit.left.value;
  if (!fit.counted_right.observable) fit.counted_right.value = fit.right.value;
  fit.slip_left = slip_of(fit.left, fit.counted_left);
  fit.slip_right = slip_of(fit.right, fit.counted_right);
  return fit;
}

}  // namespace tandem::mixed_reality
