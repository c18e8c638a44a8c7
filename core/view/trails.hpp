// Trails: where robots were in the last seconds, kept for pictures.
#pragma once
#include <cstdint>
#include <deque>
#include <span>
#include <vector>

#include "core/space/space.hpp"
#include "core/view/drawing.hpp"

namespace tandem::core {

/// Keeps up to 200 places of every robot; of long trails not every tick is kept.
class Trails {
 public:
  struct Place {
    std::uint64_t who = 0;  ///< the same for the same robot, whatever the order
    double x_m = 0.0, y_m = 0.0;
    double z_m = 0.0;
  };

  /// Trails of so many seconds; 0: none.
  Trails(double seconds, std::int64_t ticks_per_second);

  /// Whether `note` wants the places after so many ticks.
  bool wants(std::int64_t ticks_done) const noexcept;
  /// In the order of the ticks; an earlier one than before: the run started again, and so do the trails.
  void note(std::int64_t ticks_done, std::vector<Place> places);
  void note(std::int64_t ticks_done, const Space& space);
  /// Of a robot, for `Place::who`.
  static std::uint64_t number_of(RobotId robot) noexcept {
    return std::uint64_t{robot.index} << 32U | robot.generation;
  }

  /// Adds those of `who`, in the order of the drawing's robots, as they are after so many ticks.
  void add_to(Drawing& drawing, std::span<const std::uint64_t> who, std::int64_t ticks_done) const;
  void add_to(Drawing& drawing, const Space& space, std::int64_t ticks_done) const;

 private:
  struct Kept {
    std::int64_t ticks_done = 0;
    std::vector<Place> places;
  };
  std::int64_t span_ = 0, every_ = 1;  // in ticks
  std::deque<Kept> kept_;
};

}  // namespace tandem::core
