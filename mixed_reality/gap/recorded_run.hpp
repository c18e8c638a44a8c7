// What a record tells of each robot, tick by tick: pose, commands of its wheels, encoders, proximity readings.
#pragma once
#include <cstdint>
#include <string>
#include <vector>

#include "hal/json/json.hpp"
#include "hal/result.hpp"
#include "hal/time.hpp"

namespace tandem::mixed_reality {

struct RecordedTick {
  bool posed = false;    ///< the next three were recorded
  bool told = false;     ///< so were the commands
  bool sent = false;     ///< … as they were sent to a real robot, whoever gave them
  bool counted = false;  ///< so was what the encoders say
  bool held = false;     ///< somebody else held the robot: its command may not have reached it
  double x_m = 0.0, y_m = 0.0, heading_rad = 0.0;      ///< in W, at the tick
  double told_left_m_s = 0.0, told_right_m_s = 0.0;    ///< from this tick on
  double counted_left_m = 0.0, counted_right_m = 0.0;  ///< as they were at the tick
};

struct RecordedRobot {
  std::string id, kind;
  bool real = false;
  std::vector<RecordedTick> ticks;  ///< from RecordedRun::first on
  std::size_t rays = 0;             ///< proximity sensors; 0: not recorded
  std::vector<float> near_m;        ///< of each tick, `rays` each; NaN: not recorded
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
  std::vector<RecordedRobot> robots;  ///< by length and letters of their ids
  std::vector<std::string> damage;

  double tick_s() const noexcept { return 1.0 / static_cast<double>(ticks_per_second); }
  const RecordedRobot* find(const std::string& id) const noexcept;
};

/// Reads a record whole. Of real robots the pose is the one that was latched, of others the one after the tick.
/// Errors: no record; nobody's poses in it.
hal::Result<RecordedRun> read_recorded_run(const std::string& path);

}  // namespace tandem::mixed_reality
