// The distances that proximity sensors should read by the recorded poses and the recorded scene.
#pragma once
#include <string>
#include <vector>

#include "hal/robot_kind.hpp"
#include "mixed_reality/gap/recorded_run.hpp"

namespace tandem::mixed_reality {

/// What stands still in the scene, and the other robots.
class Surroundings {
 public:
  /// `radius_m`: of the bodies of `run`'s robots, in their order. The run must outlive this.
  Surroundings(const RecordedRun& run, std::vector<double> radius_m);

  /// Along each mount of `robot` at a tick, from the sensor; `range_m` where there is nothing nearer. `turn_rad` turns
  /// the robot for once.
  std::vector<double> distances(std::size_t robot, std::size_t tick, const std::vector<hal::Mount>& mounts,
                                double range_m, double turn_rad = 0.0) const;

 private:
  struct Box {
    double x_m, y_m, c, s, half_x_m, half_y_m;
  };
  struct Disc {
    double x_m, y_m, radius_m;
  };
  const RecordedRun& run_;
  std::vector<double> radius_m_;
  std::vector<Box> boxes_;
  std::vector<Disc> discs_;
};

}  // namespace tandem::mixed_reality
