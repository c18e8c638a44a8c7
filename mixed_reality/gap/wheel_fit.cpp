#include "mixed_reality/gap/wheel_fit.hpp"

#include <algorithm>
#include <cmath>
#include <limits>

#include "mixed_reality/gap/count_model.hpp"
#include "mixed_reality/gap/way_model.hpp"

namespace tandem::mixed_reality {
namespace {

constexpr double kTold = 0.4;            // of what was known before: a parameter with a larger error is not told
constexpr double kLongestDelay_s = 0.6;  // that is looked for
constexpr double kShortestDelay_s = -0.1;
constexpr double kDelayStep_s = 0.02;
constexpr double kPlayGain = 6.0;    // by which the logarithm of the likelihood must rise for play to be believed
constexpr double kStamps_s = 1e-4;   // standard error of any delay at least: steps of time that no scatter shows
constexpr std::size_t kFewest = 30;  // places or counts
constexpr double kStanding_m_s = 1e-4;
constexpr double kFallen = 1.92;       // of the likelihood's logarithm at the ends of an interval of 95 %
constexpr double kClear = 0.15;        // error of its logarithm with which noise is far from none
constexpr double kMostNoise_m = 0.02;  // after 1 m: an interval from 0 that ends above it tells nothing

/// The best of a row of delays, for the search to begin with.
template <class Likelihood>
void start_delay(Likelihood& search, int param) {
  double best = std::numeric_limits<double>::infinity();
  auto first = search.setup().first;
  for (double delay_s = kShortestDelay_s; delay_s <= kLongestDelay_s; delay_s += kDelayStep_s) {
    auto tried = search.setup().first;
    tried[param] = delay_s;
    const double cost = search.cost_of(tried);
    if (cost >= best) continue;
    best = cost;
    first = tried;
  }
  search.setup().first = first;
  search.set(first);
}

template <class Innovations>
std::size_t used(const Innovations& innovations) {
  return static_cast<std::size_t>(
      std::count_if(innovations.begin(), innovations.end(), [](const auto& i) { return i.there; }));
}

/// Bounds of noise that may be none: a logarithm tells nothing of 0. Where the likelihood falls by less than kFallen
/// towards 0, the interval begins there, and ends where the likelihood has fallen by that much.
void tell_noise_from_none(WayModel::Likelihood search, Estimate& noise) {
  if (noise.error < kClear) return;
  const WayModel::Params best = search.values();
  const double cost = search.cost_of(best);
  search.fix(WayModel::kNoise, true);
  const auto falls_to = [&](double log_noise) {
    WayModel::Params tried = best;
    tried[WayModel::kNoise] = log_noise;
    search.set(tried);
    search.search();
    return search.cost_of(search.values()) > cost + kFallen;
  };
  if (falls_to(search.setup().least[WayModel::kNoise])) return;
  double in = best[WayModel::kNoise], out = std::log(kMostNoise_m);
  noise.observable = in < out && falls_to(out);
  while (noise.observable && out - in > 0.05) {
    const double middle = 0.5 * (in + out);
    (falls_to(middle) ? out : in) = middle;
  }
  noise.most = std::exp(out);
}

/// The way and its places. @returns false: too few follow from commands
bool fit_way(const WheelSeries& series, double wheel_base_m, WheelFit& fit) {
  WayModel model(series, wheel_base_m);
  WayModel::Likelihood search([&model](const auto& v, auto& out) { model.run(v, out); }, WayModel::setup());
  search.fix(WayModel::kPlay, true);
  start_delay(search, WayModel::kDelay);
  search.search();
  for (int round = 0; round < 4 && model.leave_out(search.innovations()); ++round) search.search();
  fit.ticks = used(search.innovations());
  if (fit.ticks < kFewest) return false;
  // Play passes for a delay; where there is none, looking for it would only blur that.
  const WayModel::Params without = search.values();
  const double cost_without = search.cost();
  WayModel::Params with = without;
  with[WayModel::kPlay] = 2e-4;
  search.set(with);
  search.fix(WayModel::kPlay, false);
  search.search();
  if (search.cost() > cost_without - kPlayGain) {
    search.fix(WayModel::kPlay, true);
    search.set(without);
    search.search();
  }
  const bool plays = search.values()[WayModel::kPlay] > 0.0;
  fit.left_out = model.left_out();
  const WayModel::Params v = search.values(), e = search.errors(), prior = search.setup().prior;
  const auto plain = [&](int k) { return Estimate{v[k], e[k], e[k] < kTold * prior[k]}; };
  const auto by_factor = [&](int k) { return Estimate{std::exp(v[k]), e[k], e[k] < 1.0, true}; };
  fit.left = plain(WayModel::kLeft);
  fit.right = plain(WayModel::kRight);
  fit.base = plain(WayModel::kBase);
  fit.delay_s = plain(WayModel::kDelay);
  fit.delay_s.error = std::hypot(fit.delay_s.error, kStamps_s);
  fit.mount_rad = plain(WayModel::kMount);
  fit.play_m = plays ? plain(WayModel::kPlay) : Estimate{};
  fit.noise_sqrt_m = by_factor(WayModel::kNoise);
  tell_noise_from_none(search, fit.noise_sqrt_m);
  fit.place_noise_m = by_factor(WayModel::kPlaceM);
  fit.place_noise_rad = by_factor(WayModel::kPlaceRad);
  return true;
}

void fit_counts(const WheelSeries& series, WheelFit& fit) {
  fit.counted_left = fit.counted_right = {1.0, 0.0, false};
  if (series.counts.size() < kFewest) return;
  const CountModel model(series);
  CountModel::Likelihood search([&model](const auto& v, auto& out) { model.run(v, out); }, CountModel::setup());
  start_delay(search, CountModel::kDelay);
  search.search();
  if (used(search.innovations()) < kFewest) return;
  const CountModel::Params v = search.values(), e = search.errors(), prior = search.setup().prior;
  const auto plain = [&](int k) { return Estimate{v[k], e[k], e[k] < kTold * prior[k]}; };
  fit.counted_left = plain(CountModel::kLeft);
  fit.counted_right = plain(CountModel::kRight);
  fit.counter_delay_s = plain(CountModel::kDelay);
  fit.counter_delay_s.error = std::hypot(fit.counter_delay_s.error, kStamps_s);
}

Estimate slip_of(const Estimate& rolled, const Estimate& counted) {
  if (!rolled.observable || !counted.observable || std::fabs(counted.value) < 0.1) return {};
  const double ratio = rolled.value / counted.value;
  return {1.0 - ratio, ratio * std::hypot(rolled.error / rolled.value, counted.error / counted.value), true};
}

DelayEstimate told(const Estimate& e) {
  return {e.value, e.bound(), e.observable};
}

/// Which delays are told by what was found.
void judge_delays(const WheelSeries& series, const WheelFitOptions& options, WheelFit& fit) {
  if (options.round_trip_s) fit.round_trip_s = {*options.round_trip_s, options.round_trip_jitter_s, true};
  const bool seen =
      !options.poses_by_wheels && !options.poses_drawn && series.stamps_are_right && fit.delay_s.observable;
  if (!seen) fit.delay_s = {};
  if (seen && fit.counter_delay_s.observable)
    fit.lag_s = {fit.delay_s.value - fit.counter_delay_s.value,
                 std::hypot(fit.delay_s.error, fit.counter_delay_s.error), true};
  fit.parts = parts_of(told(fit.delay_s), told(fit.counter_delay_s), told(fit.round_trip_s));
}

bool any_command(const WheelSeries& series, bool moves) {
  return std::any_of(series.commands.begin(), series.commands.end(), [moves](const WheelSeries::Command& c) {
    return c.known && (!moves || std::fabs(c.left_m_s) > kStanding_m_s || std::fabs(c.right_m_s) > kStanding_m_s);
  });
}

}  // namespace

double Estimate::low() const noexcept {
  if (most) return 0.0;
  return by_factor ? value * std::exp(-1.96 * error) : value - 1.96 * error;
}
double Estimate::high() const noexcept {
  if (most) return *most;
  return by_factor ? value * std::exp(1.96 * error) : value + 1.96 * error;
}

hal::WheelModel WheelFit::values() const noexcept {
  // A delay that no tracker told is at least that of the counters.
  const double delay = delay_s.observable ? delay_s.value : counter_delay_s.observable ? counter_delay_s.value : 0.0;
  return {left.value,          right.value,        base.value,          counted_left.value,
          counted_right.value, noise_sqrt_m.value, std::max(0.0, delay)};
}

hal::WheelModel WheelFit::errors() const noexcept {
  const auto linear = [](const Estimate& e) {
    return e.most ? e.bound() / 1.96 : e.by_factor ? e.value * e.error : e.error;
  };
  return {left.error,          right.error,          base.error,   counted_left.error,
          counted_right.error, linear(noise_sqrt_m), delay_s.error};
}

WheelFit fit_wheels(const WheelSeries& series, const WheelFitOptions& options) {
  WheelFit fit;
  if (!any_command(series, false)) {
    fit.flaw =
        "the record has no commands of its wheels; record them with <record inputs=\"true\"/> of real robots, <record "
        "ports=\"differential_steering\"/> of simulated ones";
    return fit;
  }
  if (!any_command(series, true)) {
    fit.flaw = "it was never told to move";
    return fit;
  }
  if (!fit_way(series, options.wheel_base_m, fit)) {
    fit.flaw = "fewer than " + std::to_string(kFewest) + " places follow from commands";
    return fit;
  }
  fit_counts(series, fit);
  if (options.poses_by_wheels) {
    for (Estimate* by_trackers : {&fit.left, &fit.right, &fit.base, &fit.mount_rad, &fit.play_m, &fit.noise_sqrt_m,
                                  &fit.place_noise_m, &fit.place_noise_rad})
      by_trackers->observable = false;
  }
  for (Estimate* of : {&fit.left, &fit.right, &fit.base}) {
    if (!of->observable) of->value = 1.0;
  }
  if (!fit.noise_sqrt_m.observable) fit.noise_sqrt_m.value = 0.0;
  if (!fit.counted_left.observable) fit.counted_left.value = fit.left.value;
  if (!fit.counted_right.observable) fit.counted_right.value = fit.right.value;
  fit.slip_left = slip_of(fit.left, fit.counted_left);
  fit.slip_right = slip_of(fit.right, fit.counted_right);
  judge_delays(series, options, fit);
  return fit;
}

WheelFit fit_wheels(const RecordedRobot& robot, double tick_s, const WheelFitOptions& options) {
  RecordedRun run;
  run.ticks_per_second = std::lround(1.0 / tick_s);
  return fit_wheels(wheel_series(run, robot), options);
}

}  // namespace tandem::mixed_reality
