// Maximum likelihood of a filter's innovations, by Fisher scoring [Ljung 1999, System Identification, section 7.4].
#pragma once
#include <Eigen/Cholesky>
#include <Eigen/LU>
#include <algorithm>
#include <array>
#include <cmath>
#include <cstddef>
#include <functional>
#include <vector>

#include "hal/angle.hpp"

namespace tandem::mixed_reality {

/// Finds `kParams` parameters of a model that predicts measurements of `kSize` numbers. `kAngle`: which of these is an
/// angle; negative: none.
template <int kParams, int kSize, int kAngle = -1>
class MaximumLikelihood {
 public:
  using Params = Eigen::Matrix<double, kParams, 1>;
  using Information = Eigen::Matrix<double, kParams, kParams>;
  using Vector = Eigen::Matrix<double, kSize, 1>;
  using Square = Eigen::Matrix<double, kSize, kSize>;

  /// What a measurement differs by from its prediction, and the covariance of that.
  struct Innovation {
    Vector e = Vector::Zero();
    Square s = Square::Identity();
    double t_s = 0.0;
    bool there = false;
  };
  using Innovations = std::vector<Innovation>;
  /// The innovations under these parameters: always as many.
  using Model = std::function<void(const Params&, Innovations&)>;

  struct Setup {
    Params first;        ///< where the search begins
    Params prior;        ///< standard deviations around that, before anything is known
    Params step;         ///< of numeric derivatives
    Params least, most;  ///< of the search
    std::array<bool, kParams> fixed{};
  };
  static constexpr double kOutlier = 25.0;   ///< chi square: beyond it a measurement weighs nothing
  static constexpr double kStretch_s = 4.0;  ///< over which scores are added up

  MaximumLikelihood(Model model, const Setup& setup) : model_(std::move(model)), setup_(setup), v_(setup.first) {}

  /// Searches from where the last search ended.
  void search() {
    model_(v_, now_);
    double cost_now = cost(now_) + prior_cost(v_);
    double damping = 1e-3;
    for (int round = 0; round < 40; ++round) {
      score();
      bool better = false;
      double gained = 0.0;
      for (int tries = 0; tries < 8 && !better; ++tries) {
        const Params next = stepped(damping);
        model_(next, trial_);
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
      if (!better || gained < 1e-3) break;
    }
    cost_ = cost_now;
    score();
  }

  void set(const Params& values) { v_ = values; }
  void fix(int param, bool fixed) { setup_.fixed[static_cast<std::size_t>(param)] = fixed; }
  Setup& setup() noexcept { return setup_; }
  const Params& values() const noexcept { return v_; }
  const Innovations& innovations() const noexcept { return now_; }
  /// Minus the logarithm of likelihood and prior, where the last search ended.
  double cost() const noexcept { return cost_; }
  double cost_of(const Params& values) {
    model_(values, trial_);
    return cost(trial_);
  }

  /// Standard errors: of a true model; where scores scatter more over stretches than chance explains, of one that need
  /// not be [White 1982, Econometrica 50(1)].
  Params errors() const {
    const Information inverse = information_.inverse();
    const Information honest = inverse * scatter_ * inverse;
    const double by_chance = 1.0 + 3.0 * std::sqrt(2.0 / static_cast<double>(std::max<std::size_t>(1, stretches_)));
    Params e;
    for (int k = 0; k < kParams; ++k)
      e[k] = std::sqrt(std::max(0.0, honest(k, k) > by_chance * inverse(k, k) ? honest(k, k) : inverse(k, k)));
    return e;
  }

  static double chi_square(const Innovation& i) { return i.e.dot(i.s.ldlt().solve(i.e)); }

 private:
  bool fixed(int k) const { return setup_.fixed[static_cast<std::size_t>(k)]; }

  static double cost(const Innovations& innovations) {
    double sum = 0.0;
    for (const Innovation& i : innovations) {
      if (i.there) sum += 0.5 * (std::log(i.s.determinant()) + std::min(i.e.dot(i.s.inverse() * i.e), kOutlier));
    }
    return sum;
  }
  double prior_cost(const Params& v) const {
    return 0.5 * ((v - setup_.first).cwiseQuotient(setup_.prior)).squaredNorm();
  }

  Params stepped(double damping) const {
    Information damped = information_;
    damped.diagonal() *= 1.0 + damping;
    Params next = v_ + damped.ldlt().solve(gradient_).cwiseMax(-0.5 * setup_.prior).cwiseMin(0.5 * setup_.prior);
    next = next.cwiseMax(setup_.least).cwiseMin(setup_.most);
    for (int k = 0; k < kParams; ++k) {
      if (fixed(k)) next[k] = v_[k];
    }
    return next;
  }

  /// Gradient, information and scatter of the likelihood's logarithm at v_, whose innovations are in now_.
  void score() {
    for (int k = 0; k < kParams; ++k) {
      if (fixed(k)) continue;
      const auto i = static_cast<std::size_t>(k);
      Params up = v_, down = v_;
      up[k] = std::min(setup_.most[k], v_[k] + setup_.step[k]);
      down[k] = std::max(setup_.least[k], v_[k] - setup_.step[k]);
      model_(up, up_[i]);
      model_(down, down_[i]);
      per_step_[i] = 1.0 / (up[k] - down[k]);
    }
    gradient_.setZero();
    information_.setZero();
    scatter_.setZero();
    stretches_ = 0;
    Params stretch = Params::Zero();
    double until_s = 0.0;
    bool any = false;
    for (std::size_t n = 0; n < now_.size(); ++n) {
      if (!now_[n].there) continue;
      if (any && now_[n].t_s >= until_s) close(stretch);
      if (!any || now_[n].t_s >= until_s) until_s = now_[n].t_s + kStretch_s;
      any = true;
      stretch += score_of(n);
    }
    if (any) close(stretch);
    for (int k = 0; k < kParams; ++k) {
      information_(k, k) += fixed(k) ? 1e18 : 1.0 / (setup_.prior[k] * setup_.prior[k]);
      gradient_[k] -= (v_[k] - setup_.first[k]) / (setup_.prior[k] * setup_.prior[k]);
    }
  }
  void close(Params& stretch) {
    scatter_ += stretch * stretch.transpose();
    stretch.setZero();
    ++stretches_;
  }

  Params score_of(std::size_t n) {
    const Innovation& i = now_[n];
    const Square inverse = i.s.inverse();
    const Vector w = inverse * i.e;
    const double weight = i.e.dot(w) > kOutlier ? 0.0 : 1.0;
    std::array<Vector, kParams> de;
    std::array<Square, kParams> a;
    Params score = Params::Zero();
    for (int k = 0; k < kParams; ++k) {
      const auto j = static_cast<std::size_t>(k);
      if (fixed(k)) {
        de[j].setZero();
        a[j].setZero();
        continue;
      }
      Vector d = up_[j][n].e - down_[j][n].e;
      if constexpr (kAngle >= 0) d[kAngle] = hal::wrapped(d[kAngle]);
      de[j] = d * per_step_[j];
      const Square ds = (up_[j][n].s - down_[j][n].s) * per_step_[j];
      a[j] = inverse * ds;
      score[k] = weight * (-0.5 * a[j].trace() - w.dot(de[j]) + 0.5 * w.dot(ds * w));
    }
    for (int k = 0; k < kParams; ++k) {
      const auto x = static_cast<std::size_t>(k);
      for (int l = 0; l <= k; ++l) {
        const auto y = static_cast<std::size_t>(l);
        const double value = weight * (de[x].dot(inverse * de[y]) + 0.5 * (a[x] * a[y]).trace());
        information_(k, l) += value;
        if (k != l) information_(l, k) += value;
      }
    }
    gradient_ += score;
    return score;
  }

  Model model_;
  Setup setup_;
  Params v_, gradient_ = Params::Zero();
  Information information_ = Information::Zero(), scatter_ = Information::Zero();
  Innovations now_, trial_;
  std::array<Innovations, kParams> up_, down_;
  std::array<double, kParams> per_step_{};
  std::size_t stretches_ = 0;
  double cost_ = 0.0;
};

}  // namespace tandem::mixed_reality
