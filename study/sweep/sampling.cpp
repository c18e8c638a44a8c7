#include "study/sweep/sampling.hpp"

#include <algorithm>
#include <cmath>
#include <limits>

#include "core/record/trajectory.hpp"

namespace tandem::study {
namespace {

bool wanted(const Measuring& what, const std::string& name) {
  return std::any_of(what.names.begin(), what.names.end(),
                     [&](const std::string& pattern) { return core::fits_pattern(name, pattern); });
}

/// NaN: nobody publishes it.
double over_robots(const core::Space& space, const PublishedMeasure& m) {
  double sum = 0.0, low = std::numeric_limits<double>::infinity(), high = -low;
  std::size_t count = 0;
  for (std::size_t i = 0; i < space.robot_count(); ++i) {
    auto value = space.published_value(space.robot(i), m.published);
    if (!value.ok()) continue;
    ++count;
    sum += *value;
    low = std::min(low, *value);
    high = std::max(high, *value);
  }
  if (count == 0) return std::numeric_limits<double>::quiet_NaN();
  switch (m.over) {
    case Over::Sum:
      return sum;
    case Over::Min:
      return low;
    case Over::Max:
      return high;
    case Over::Mean:
      break;
  }
  return sum / static_cast<double>(count);
}

}  // namespace

std::vector<std::pair<std::string, double>> measure(const core::World& world, const Measuring& what) {
  std::vector<std::pair<std::string, double>> all;
  for (const auto& [name, value] : world.measures().all()) {
    if (wanted(what, name)) all.emplace_back(name, value);
  }
  for (const PublishedMeasure& m : what.published) {
    if (const double value = over_robots(world.space(), m); !std::isnan(value)) all.emplace_back(m.name, value);
  }
  std::stable_sort(all.begin(), all.end(), [](const auto& a, const auto& b) { return a.first < b.first; });
  all.erase(std::unique(all.begin(), all.end(), [](const auto& a, const auto& b) { return a.first == b.first; }),
            all.end());
  return all;
}

Sampler::Sampler(const Measuring& what, std::int64_t ticks_per_second) : what_(what) {
  if (what.every_s > 0.0) {
    const double ticks = what.every_s * static_cast<double>(ticks_per_second);
    every_ = std::max<std::int64_t>(1, std::llround(ticks));
  }
}

void Sampler::tick_done(const core::World& world) {
  if (every_ == 0) return;
  const std::int64_t now = world.tick();
  while (!ticks_.empty() && ticks_.back() >= now) {
    ticks_.pop_back();
    for (auto& [name, values] : values_) {
      if (values.size() > ticks_.size()) values.pop_back();
    }
  }
  if (now == 0 || now % every_ != 0) return;
  for (const auto& [name, value] : measure(world, what_)) {
    auto found =
        std::find_if(values_.begin(), values_.end(), [&name = name](const auto& known) { return known.first == name; });
    if (found == values_.end()) found = values_.insert(values_.end(), {name, {}});
    found->second.resize(ticks_.size(), std::numeric_limits<double>::quiet_NaN());
    found->second.push_back(value);
  }
  ticks_.push_back(now);
}

void Sampler::take(RunOutcome& outcome) {
  for (auto& [name, values] : values_) values.resize(ticks_.size(), std::numeric_limits<double>::quiet_NaN());
  outcome.sample_ticks = std::move(ticks_);
  outcome.samples = std::move(values_);
}

}  // namespace tandem::study
