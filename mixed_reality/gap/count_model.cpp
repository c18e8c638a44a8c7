#include "mixed_reality/gap/count_model.hpp"

#include <algorithm>
#include <cmath>

namespace tandem::mixed_reality {
namespace {

constexpr double kJump_m = 0.05;  // beyond what was commanded: the counter was reset, or misread

}  // namespace

CountModel::CountModel(const WheelSeries& series) : series_(series) {
  Way way{0.0, 0.0, 0};
  for (std::size_t i = 0; i < series.commands.size(); ++i) {
    if (i > 0) {
      const WheelSeries::Command& last = series.commands[i - 1];
      const double s = series.commands[i].at_s - last.at_s;
      way.left_m += last.left_m_s * s;
      way.right_m += last.right_m_s * s;
    }
    until_.push_back(way);
  }
}

CountModel::Likelihood::Setup CountModel::setup() {
  Likelihood::Setup s;
  s.first << 1.0, 1.0, 0.0, std::log(0.001), std::log(0.0005), std::log(0.001);
  s.prior << 0.3, 0.3, 0.25, 3.0, 3.0, 3.0;
  s.step << 1e-5, 1e-5, 1e-5, 1e-3, 1e-3, 1e-3;
  s.least << 0.1, 0.1, -0.3, -12.0, -12.0, -12.0;
  s.most << 10.0, 10.0, 1.0, 0.0, 0.0, -1.0;
  return s;
}

CountModel::Way CountModel::way_until(double t_s) const {
  const auto& commands = series_.commands;
  const auto next = std::upper_bound(commands.begin(), commands.end(), t_s,
                                     [](double t, const WheelSeries::Command& c) { return t < c.at_s; });
  const auto i = static_cast<std::size_t>(next - commands.begin());
  if (i == 0) return {0.0, 0.0, 0};
  const double s = t_s - commands[i - 1].at_s;
  return {until_[i - 1].left_m + commands[i - 1].left_m_s * s, until_[i - 1].right_m + commands[i - 1].right_m_s * s,
          i};
}

void CountModel::run(const Params& v, Likelihood::Innovations& out) const {
  const double walk2 = std::exp(2.0 * v[kWalk]), noise2 = std::exp(2.0 * v[kNoise]);
  const double jitter2 = std::exp(2.0 * v[kJitter]);
  out.assign(series_.counts.size(), {});
  double left_m = 0.0, right_m = 0.0, left_var = 0.0, right_var = 0.0;  // what the counters should say
  bool known = false;
  Way before{0.0, 0.0, 0};
  for (std::size_t i = 0; i < series_.counts.size(); ++i) {
    const WheelSeries::Count& count = series_.counts[i];
    const Way way = way_until(count.at_s - v[kDelay]);
    for (std::size_t c = std::max<std::size_t>(1, before.command); c <= way.command; ++c) {
      const WheelSeries::Command& now = series_.commands[c - 1];
      known = known && now.known;
      if (c == before.command) continue;
      const double last_left = c > 1 ? series_.commands[c - 2].left_m_s : 0.0;
      const double last_right = c > 1 ? series_.commands[c - 2].right_m_s : 0.0;
      left_var += jitter2 * (now.left_m_s - last_left) * (now.left_m_s - last_left);
      right_var += jitter2 * (now.right_m_s - last_right) * (now.right_m_s - last_right);
    }
    const double left = way.left_m - before.left_m, right = way.right_m - before.right_m;
    before = way;
    left_m += v[kLeft] * left;
    right_m += v[kRight] * right;
    left_var += walk2 * std::fabs(left);
    right_var += walk2 * std::fabs(right);
    const Eigen::Vector2d e(count.left_m - left_m, count.right_m - right_m);
    if (!known || std::fabs(e.x()) > kJump_m || std::fabs(e.y()) > kJump_m) {
      left_m = count.left_m;
      right_m = count.right_m;
      left_var = right_var = noise2;
      known = true;
      continue;
    }
    Likelihood::Innovation& in = out[i];
    in.t_s = count.at_s;
    in.e = e;
    in.s = Eigen::Vector2d(left_var + noise2, right_var + noise2).asDiagonal();
    in.there = true;
    const double gain_left = left_var / in.s(0, 0), gain_right = right_var / in.s(1, 1);
    left_m += gain_left * e.x();
    right_m += gain_right * e.y();
    left_var *= 1.0 - gain_left;
    right_var *= 1.0 - gain_right;
  }
}

}  // namespace tandem::mixed_reality
