// What a record tells of one robot's wheels, on one clock: commands as they were given, places, counters.
#pragma once
#include <limits>
#include <vector>

#include "mixed_reality/gap/recorded_run.hpp"

namespace tandem::mixed_reality {

/// Times are in seconds of the hub's monotonic clock since the record's first tick: the run's time, where no slots were
/// left out. Each series is in the order of time.
struct WheelSeries {
  struct Command {
    double at_s = 0.0;  ///< from here on, until the next
    double left_m_s = 0.0, right_m_s = 0.0;
    bool known = true;  ///< false: the commands are unknown
  };
  struct Place {
    double at_s = 0.0;
    double x_m = 0.0, y_m = 0.0;
    double heading_rad = std::numeric_limits<double>::quiet_NaN();  ///< NaN: not seen
  };
  struct Count {
    double at_s = 0.0;
    double left_m = 0.0, right_m = 0.0;
  };
  std::vector<Command> commands;
  std::vector<Place> places;
  std::vector<Count> counts;
  bool stamps_are_right = true;  ///< of the places: true of those of ticks
};

/// Places are what trackers saw; where they saw nothing, the poses of ticks.
WheelSeries wheel_series(const RecordedRun& run, const RecordedRobot& robot);

}  // namespace tandem::mixed_reality
