// How far simulated robots go astray from where the real ones were.
#pragma once
#include <cstddef>
#include <string>
#include <vector>

#include "core/space/pose.hpp"
#include "hal/json/json.hpp"
#include "hal/time.hpp"

namespace tandem::mixed_reality {

/// Of one robot, over the ticks in which both are known.
class Deviation {
 public:
  explicit Deviation(std::string robot) : robot_(std::move(robot)) {}

  void note(hal::Tick tick, const core::Pose& simulated, const core::Pose& real);

  const std::string& robot() const noexcept { return robot_; }
  std::size_t ticks() const noexcept { return all_.size(); }
  double rms_m() const noexcept;
  double rms_rad() const noexcept;
  double max_m() const noexcept;
  double last_m() const noexcept { return all_.empty() ? 0.0 : all_.back().m; }
  /// Largest distance in the first so many ticks.
  double max_within_m(hal::Tick ticks) const noexcept;
  /// {"robot", "ticks", "rms_m", "rms_rad", "max_m", "max_at_tick", "last_m", "every_second_m": […]}
  hal::Json json(std::int64_t ticks_per_second) const;

 private:
  struct At {
    hal::Tick tick = 0;
    double m = 0.0, rad = 0.0;
  };
  std::string robot_;
  std::vector<At> all_;
};

}  // namespace tandem::mixed_reality
