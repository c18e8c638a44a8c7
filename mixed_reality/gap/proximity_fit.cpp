#include "mixed_reality/gap/proximity_fit.hpp"

#include <Eigen/Cholesky>
#include <Eigen/LU>
#include <algorithm>
#include <array>
#include <cmath>
#include <limits>

namespace tandem::mixed_reality {
namespace {

enum Param : int { kGain, kExponent, kOffset, kDelay, kParams };
using Params = Eigen::Matrix<double, kParams, 1>;
using Information = Eigen::Matrix<double, kParams, kParams>;

constexpr double kLongestDelay_s = 0.5;
constexpr double kEdge_rad = 0.05;  // a ray whose distance changes much within it meets an edge
constexpr double kEdge = 0.15;      // how much, in parts of the range
constexpr double kFar = 0.85;       // beyond, in parts of the range, readings end at the range
constexpr double kNear = 0.02;
constexpr std::size_t kFewest = 40;
constexpr double kStretch_s = 2.0;

/// One reading with what should have been read now and in ticks before.
struct Point {
  std::size_t tick, ray;
  double read_m;
};

class Fit {
 public:
  Fit(const ProximitySeries& series, double tick_s)
      : series_(series), tick_s_(tick_s), ticks_(series.rays == 0 ? 0 : series.distance_m.size() / series.rays) {
    for (std::size_t t = 0; t < ticks_; ++t) {
      for (std::size_t k = 0; k < series.rays; ++k) {
        const auto read_m = static_cast<double>(series.read_m[t * series.rays + k]);
        if (read_m > 1e-4 && read_m < 0.995 * series.range_m) points_.push_back({t, k, read_m});
      }
    }
  }

  bool search() {
    double least = std::numeric_limits<double>::infinity();
    Params best;
    for (double delay_s = 0.0; delay_s <= kLongestDelay_s; delay_s += 0.25 * tick_s_) {
      Params v;
      v << 1.0, 1.0, 0.0, delay_s;
      for (int round = 0; round < 6; ++round) step(v, false);
      const double c = cost(v);
      if (used_ >= kFewest && c < least) {
        least = c;
        best = v;
      }
    }
    if (!std::isfinite(least)) return false;
    v_ = best;
    for (int round = 0; round < 12; ++round) step(v_, true);
    cost(v_);
    return used_ >= kFewest;
  }

  const Params& values() const noexcept { return v_; }
  double noise_m() const noexcept { return noise_m_; }
  std::size_t used() const noexcept { return used_; }

  /// Standard errors; of a model that need not be true.
  void errors(Params& together, Params& one_by_one) {
    Information scatter = Information::Zero(), information = Information::Zero();
    Params stretch = Params::Zero();
    std::size_t end = 0;
    const auto stretch_ticks = std::max<std::size_t>(1, static_cast<std::size_t>(kStretch_s / tick_s_));
    for (const Point& p : points_) {
      double r = 0.0;
      Params j;
      if (!residual(p, v_, r, &j) || std::fabs(r) > 3.5 * noise_m_) continue;
      if (p.tick >= end) {
        scatter += stretch * stretch.transpose();
        stretch.setZero();
        end = p.tick + stretch_ticks;
      }
      stretch += j * r;
      information += j * j.transpose();
    }
    scatter += stretch * stretch.transpose();
    const Information inverse = (information + 1e-12 * Information::Identity()).inverse();
    const Information honest = inverse * scatter * inverse;
    for (int k = 0; k < kParams; ++k) {
      together[k] = std::sqrt(std::max({honest(k, k), inverse(k, k) * noise_m_ * noise_m_, 0.0}));
      one_by_one[k] = std::sqrt(scatter(k, k)) / std::max(1e-12, information(k, k));
    }
  }

 private:
  /// The distance of `delay_s` ago; NaN: there is none that can be relied on.
  double seen_m(const Point& p, double delay_s) const {
    const double ticks = std::max(0.0, delay_s) / tick_s_;
    const auto whole = static_cast<std::size_t>(ticks);
    const double rest = ticks - static_cast<double>(whole);
    if (p.tick < whole + 1) return std::numeric_limits<double>::quiet_NaN();
    const std::size_t at = (p.tick - whole) * series_.rays + p.ray;
    return (1.0 - rest) * series_.distance_m[at] + rest * series_.distance_m[at - series_.rays];
  }

  /// Reading less model, and the model's derivatives. False: the point says nothing.
  bool residual(const Point& p, const Params& v, double& r, Params* j) const {
    const double range = series_.range_m;
    const double seen = seen_m(p, v[kDelay]);
    if (!(seen > kNear * range && seen < kFar * range)) return false;
    const double x = seen / range;
    const double power = std::pow(x, v[kExponent]);
    r = p.read_m - (range * v[kGain] * power + v[kOffset]);
    if (j == nullptr) return true;
    constexpr double kStep_s = 1e-3;
    const double later = seen_m(p, v[kDelay] + kStep_s), sooner = seen_m(p, std::max(0.0, v[kDelay] - kStep_s));
    const double between = v[kDelay] < kStep_s ? v[kDelay] + kStep_s : 2.0 * kStep_s;
    const double slope = range * v[kGain] * v[kExponent] * power / seen;
    *j << range * power, range * v[kGain] * power * std::log(x), 1.0,
        std::isfinite(later - sooner) ? slope * (later - sooner) / between : 0.0;
    return true;
  }

  /// Gauss-Newton, by the points that are not outliers.
  void step(Params& v, bool with_delay) {
    cost(v);
    Information a = Information::Zero();
    Params b = Params::Zero();
    for (const Point& p : points_) {
      double r = 0.0;
      Params j;
      if (!residual(p, v, r, &j) || std::fabs(r) > 3.5 * noise_m_) continue;
      if (!with_delay) j[kDelay] = 0.0;
      a += j * j.transpose();
      b += j * r;
    }
    // What was known before: little, and that the curve is about the ideal one.
    const double q = noise_m_ * noise_m_;
    const Params prior = (Params() << 0.5, 0.7, 0.3 * series_.range_m, 0.3).finished();
    Params middle;
    middle << 1.0, 1.0, 0.0, v[kDelay];
    for (int k = 0; k < kParams; ++k) {
      a(k, k) += q / (prior[k] * prior[k]) + 1e-18;
      b[k] += q * (middle[k] - v[k]) / (prior[k] * prior[k]);
    }
    Params change = a.ldlt().solve(b);
    if (!with_delay) change[kDelay] = 0.0;
    v += change.cwiseMax(-0.5 * prior).cwiseMin(0.5 * prior);
    v[kGain] = std::clamp(v[kGain], 0.1, 10.0);
    v[kExponent] = std::clamp(v[kExponent], 0.2, 5.0);
    v[kDelay] = std::clamp(v[kDelay], 0.0, kLongestDelay_s);
  }

  /// Sets the scale of the noise by the median, and gives the mean of what is held down.
  double cost(const Params& v) {
    deviations_.clear();
    for (const Point& p : points_) {
      double r = 0.0;
      if (residual(p, v, r, nullptr)) deviations_.push_back(std::fabs(r));
    }
    used_ = deviations_.size();
    if (used_ < kFewest) return std::numeric_limits<double>::infinity();
    const auto middle = deviations_.begin() + static_cast<std::ptrdiff_t>(used_ / 2);
    std::nth_element(deviations_.begin(), middle, deviations_.end());
    const double rough_m = 1.4826 * *middle;
    double squares = 0.0;
    std::size_t inliers = 0;
    for (const double d : deviations_) {
      if (d > 3.5 * rough_m) continue;
      squares += d * d;
      ++inliers;
    }
    noise_m_ = std::max(1e-6, inliers > 0 ? std::sqrt(squares / static_cast<double>(inliers)) : rough_m);
    return noise_m_;
  }

  const ProximitySeries& series_;
  double tick_s_;
  std::size_t ticks_;
  std::vector<Point> points_;
  std::vector<double> deviations_;
  Params v_ = Params::Zero();
  double noise_m_ = 0.0;
  std::size_t used_ = 0;
};

}  // namespace

hal::ProximityModel ProximityFit::values() const noexcept {
  return {gain.value, exponent.value, offset_m.value, noise_m.value, delay_s.value};
}

ProximitySeries proximity_series(const RecordedRun& run, std::size_t robot, const Surroundings& surroundings,
                                 const hal::ProximityPart& part) {
  const RecordedRobot& of = run.robots[robot];
  ProximitySeries series;
  if (of.rays == 0 || of.rays != part.mounts.size()) return series;
  series.rays = of.rays;
  series.range_m = part.range_m;
  series.read_m = of.near_m;
  series.distance_m.assign(of.near_m.size(), std::numeric_limits<double>::quiet_NaN());
  for (std::size_t t = 0; t < of.ticks.size(); ++t) {
    if (!of.ticks[t].posed) continue;
    const auto here = surroundings.distances(robot, t, part.mounts, part.range_m);
    const bool near = std::any_of(here.begin(), here.end(), [&](double d) { return d < part.range_m; });
    if (!near) continue;
    const auto left = surroundings.distances(robot, t, part.mounts, part.range_m, kEdge_rad);
    const auto right = surroundings.distances(robot, t, part.mounts, part.range_m, -kEdge_rad);
    for (std::size_t k = 0; k < of.rays; ++k) {
      if (std::fabs(left[k] - right[k]) < kEdge * part.range_m) series.distance_m[t * of.rays + k] = here[k];
    }
  }
  return series;
}

ProximityFit fit_proximity(const ProximitySeries& series, double tick_s) {
  ProximityFit fit;
  if (series.rays == 0) {
    fit.flaw = "the record has no readings of them";
    return fit;
  }
  Fit search(series, tick_s);
  if (!search.search()) {
    fit.flaw = "fewer than " + std::to_string(kFewest) + " readings of things that are known";
    return fit;
  }
  Params together, one;
  search.errors(together, one);
  const Params& v = search.values();
  const auto estimate = [&](Param k, double most) { return Estimate{v[k], together[k], together[k] < most}; };
  fit.readings = search.used();
  fit.gain = estimate(kGain, 0.25);
  fit.exponent = estimate(kExponent, 0.35);
  fit.offset_m = estimate(kOffset, 0.15 * series.range_m);
  fit.delay_s = estimate(kDelay, 0.1);
  const double n = static_cast<double>(fit.readings);
  fit.noise_m = {search.noise_m(), search.noise_m() / std::sqrt(2.0 * n), true};
  if (!fit.gain.observable || !fit.exponent.observable || !fit.offset_m.observable) {
    // The three are one curve: without one of them the others mean nothing.
    fit.gain = {1.0, fit.gain.error, false};
    fit.exponent = {1.0, fit.exponent.error, false};
    fit.offset_m = {0.0, fit.offset_m.error, false};
  }
  if (!fit.delay_s.observable) fit.delay_s.value = 0.0;
  const auto told = [](const Estimate& e, double error) { return e.observable ? error : 0.0; };
  fit.one_by_one = {told(fit.gain, one[kGain]), told(fit.exponent, one[kExponent]), told(fit.offset_m, one[kOffset]),
                    fit.noise_m.error, told(fit.delay_s, one[kDelay])};
  return fit;
}

}  // namespace tandem::mixed_reality
