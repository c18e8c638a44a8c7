#include "mixed_reality/gap/wheel_series.hpp"

#include <algorithm>
#include <cmath>

namespace tandem::mixed_reality {
namespace {

void add_commands(const RecordedRun& run, const RecordedRobot& robot, WheelSeries& series) {
  for (std::size_t t = 0; t < robot.ticks.size(); ++t) {
    const RobotTick& tick = robot.ticks[t];
    WheelSeries::Command command{tick.sent_ns >= 0 ? run.time_s(t, tick.sent_ns) : run.time_s(t), tick.told_left_m_s,
                                 tick.told_right_m_s, tick.told && !tick.held};
    if (!command.known) command.left_m_s = command.right_m_s = 0.0;
    if (!series.commands.empty()) {
      const WheelSeries::Command& last = series.commands.back();
      command.at_s = std::max(command.at_s, last.at_s);
      if (last.known == command.known && last.left_m_s == command.left_m_s && last.right_m_s == command.right_m_s)
        continue;
    }
    series.commands.push_back(command);
  }
}

void add_counts(const RecordedRun& run, const RecordedRobot& robot, WheelSeries& series) {
  std::int64_t last_ns = -1;
  for (std::size_t t = 0; t < robot.ticks.size(); ++t) {
    const RobotTick& tick = robot.ticks[t];
    if (!tick.counted || (tick.counted_ns >= 0 && tick.counted_ns == last_ns)) continue;
    last_ns = tick.counted_ns;
    const double at_s = tick.counted_ns >= 0 ? run.time_s(t, tick.counted_ns) : run.time_s(t);
    if (!series.counts.empty() && at_s <= series.counts.back().at_s) continue;
    series.counts.push_back({at_s, tick.counted_left_m, tick.counted_right_m});
  }
}

void add_places(const RecordedRun& run, const RecordedRobot& robot, WheelSeries& series) {
  for (const RecordedSighting& seen : robot.sightings) {
    series.places.push_back({run.time_s(seen.tick, seen.taken_ns), seen.x_m, seen.y_m, seen.heading_rad});
    series.stamps_are_right = series.stamps_are_right && seen.true_clock;
  }
  for (std::size_t t = 0; t < robot.ticks.size() && robot.sightings.empty(); ++t) {
    const RobotTick& tick = robot.ticks[t];
    if (tick.posed) series.places.push_back({run.time_s(t), tick.x_m, tick.y_m, tick.heading_rad});
  }
  std::stable_sort(series.places.begin(), series.places.end(),
                   [](const auto& a, const auto& b) { return a.at_s < b.at_s; });
}

}  // namespace

WheelSeries wheel_series(const RecordedRun& run, const RecordedRobot& robot) {
  WheelSeries series;
  add_commands(run, robot, series);
  add_counts(run, robot, series);
  add_places(run, robot, series);
  return series;
}

}  // namespace tandem::mixed_reality
