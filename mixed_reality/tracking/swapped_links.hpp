// Finds robots whose links are swapped: the wheels of one roll as trackers see another one move.
#pragma once
#include <cstddef>
#include <span>
#include <vector>

#include "hal/device/wheels.hpp"
#include "mixed_reality/time/moment.hpp"
#include "mixed_reality/tracking/motion_trail.hpp"
#include "mixed_reality/tracking/pose_measurement.hpp"

namespace tandem::mixed_reality {

/// Compares the motion of each robot's wheels with what trackers see of it; where both differ, with what they see of
/// the other robots for which both differ. Judged over the last kLast_m of the robot whose wheels rolled farthest, as
/// soon as its own did for kFirst_m (kFirstPoints_m where trackers tell no headings); believed when two judgements are
/// the same, and another robot's wheels roll as it is seen to move itself: short ways look alike by chance, and a held
/// robot's way is short. Over kAlone_m and more the first alone is believed, for the other one may be held. Any
/// permutation is found pair by pair, a robot that stands in it included. Slipping wheels, robots that are carried, and
/// trackers that err are no swap: no robot moves as they say.
///
/// Robots that move alike cannot be distinguished; they are found when they do not.
class SwappedLinks {
 public:
  static constexpr double kFirst_m = 0.05, kFirstPoints_m = 0.15, kAlone_m = 0.2, kLast_m = 0.27;
  static constexpr double kEvery_m = 0.015;
  /// By which a tracker may be later than the wheels, or (negative) earlier, beside what their stamps say.
  static constexpr hal::TimeNs kLate_ns = 150 * hal::kNsPerMs, kEarly_ns = -100 * hal::kNsPerMs;

  struct Found {
    std::size_t robot;     ///< whose wheels roll
    std::size_t moves_as;  ///< the robot that is seen to move so
  };

  /// Starts again where the number changes.
  void resize(std::size_t robots);
  std::size_t size() const noexcept { return robots_.size(); }
  /// Another robot is behind this link, or its place is not known any more.
  void forget(std::size_t robot) noexcept { robots_[robot] = {}; }
  /// Once a tick for each robot: its wheels as they were read last, and what trackers saw of it last (null: nothing).
  void note(std::size_t robot, const hal::WheelEncoders& encoders, double wheel_base_m, const PoseMeasurement* seen,
            const Moment& now) noexcept;
  /// Once a tick, after all were noted. Valid until the next call. Allocates nothing.
  std::span<const Found> judge(hal::TimeNs now_ns) noexcept;

 private:
  static constexpr std::size_t kNobody = static_cast<std::size_t>(-1);
  struct Robot {
    ReckonedTrail wheels;
    MotionTrail seen;
    bool known = false;                  // the next two, of the last reading
    double left_m = 0.0, right_m = 0.0;  //
    double sd_m = 0.0;                   // of what was seen last
    double rolled_m = 0.0, own_m = 0.0;  // in the span, and how far both are apart
    bool differs = false;
    bool points = false;             // trackers tell no heading of it
    std::size_t moves_as = kNobody;  // by the last judgement
    hal::TimeNs found_ns = -1;       // when; not again by the same way
  };

  double farthest_m(const MotionSpan& span) noexcept;
  void compare(const MotionSpan& span) noexcept;
  std::size_t who_moves_as(std::size_t robot, const MotionSpan& span) const noexcept;
  bool somebody_moves_as(std::size_t robot, const MotionSpan& span) const noexcept;
  static bool alike(const Robot& rolls, const Robot& seen, double apart_m) noexcept;

  std::vector<Robot> robots_;
  std::vector<Found> found_;
  hal::TimeNs since_ns_ = -1;
  hal::TimeNs judged_ns_ = 0;
};

}  // namespace tandem::mixed_reality
