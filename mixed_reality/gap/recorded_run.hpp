// What a record tells of each robot, tick by tick: pose, commands of its wheels, encoders, proximity readings.
#pragma once
#include <cstdint>
#include <limits>
#include <string>
#include <vector>

#include "hal/json/json.hpp"
#include "hal/result.hpp"
#include "hal/time.hpp"

namespace tandem::mixed_reality {

struct RobotTick {
  bool posed = false;                                  ///< the next three were recorded
  bool told = false;                                   ///< so were the commands
  bool sent = false;                                   ///< … as they were sent to a real robot, by any author
  bool counted = false;                                ///< so was what the encoders say
  bool held = false;                                   ///< another held the robot: its command may not have reached it
  double x_m = 0.0, y_m = 0.0, heading_rad = 0.0;      ///< in W, at the tick
  double told_left_m_s = 0.0, told_right_m_s = 0.0;    ///< from this tick on
  double counted_left_m = 0.0, counted_right_m = 0.0;  ///< as they were at `counted_ns`
  std::int64_t sent_ns = -1;     ///< when the command was given to the robot's link, on the run's clock; -1: not known
  std::int64_t counted_ns = -1;  ///< on the run's clock; -1: not known
};

/// What a tracker saw of a robot.
struct RecordedSighting {
  std::size_t tick = 0;       ///< in whose row it stands, from RecordedRun::first on
  std::int64_t taken_ns = 0;  ///< on the run's clock as it was then
  double x_m = 0.0, y_m = 0.0;
  double heading_rad = std::numeric_limits<double>::quiet_NaN();  ///< NaN: it sees a point
  bool true_clock = false;                                        ///< its stamp is no estimate
};

struct RecordedRobot {
  std::string id, kind;
  bool real = false;
  std::vector<RobotTick> ticks;  ///< from RecordedRun::first on
  std::size_t rays = 0;          ///< proximity sensors; 0: not recorded
  std::vector<float> near_m;     ///< of each tick, `rays` each; NaN: not recorded
  std::vector<RecordedSighting> sightings;
  double round_trip_s = std::numeric_limits<double>::quiet_NaN();  ///< of its link; NaN: not known
  double round_trip_jitter_s = 0.0;
};

/// The clocks of a tick.
struct RecordedClock {
  bool there = false;  ///< else the run's clock is the schedule's, and no slots were left out
  std::int64_t monotonic_ns = 0, run_ns = 0;
};

/// A whole record.
struct RecordedRun {
  std::string path;
  hal::Json start;  ///< the record's first block
  hal::Json end;    ///< its last one; null: the run was killed
  hal::Json scene;  ///< as it was first: arena and objects
  std::int64_t ticks_per_second = 10;
  hal::Tick first = 0;
  std::size_t ticks = 0;
  std::vector<RecordedClock> clocks;  ///< of each tick; may be shorter
  std::vector<RecordedRobot> robots;  ///< by length and letters of their ids
  std::vector<std::string> damage;

  double tick_s() const noexcept { return 1.0 / static_cast<double>(ticks_per_second); }
  const RecordedRobot* find(const std::string& id) const noexcept;
  /// Seconds of the hub's monotonic clock since the first tick: of a stamp on the run's clock in the row of this tick
  /// (from `first` on); without a stamp, of the tick itself.
  double time_s(std::size_t tick, std::int64_t stamp_ns) const noexcept;
  double time_s(std::size_t tick) const noexcept;
};

/// Reads a record whole. Of real robots the pose is the one that was latched, of others the one after the tick.
/// Errors: no record; no poses in it.
hal::Result<RecordedRun> read_recorded_run(const std::string& path);

}  // namespace tandem::mixed_reality
