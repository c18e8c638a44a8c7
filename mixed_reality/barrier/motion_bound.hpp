// Bounds on where a robot may come: by its commands of late, and by its command now.
//
// The contract that every bound counts on, of a robot that obeys with delay and inertia: a command may move it until
// `reaction_s` after the next one was sent, which is the latency of its link and the time in which it settles to any
// new command; meanwhile its speed and its turn rate lie between those of the commands that may move it. The robot
// stands `reaction_s` after it was told to.
#pragma once
#include <array>
#include <cstddef>

#include "hal/pose.hpp"
#include "hal/robot_kind.hpp"
#include "hal/time.hpp"

namespace tandem::mixed_reality {

/// What a body does. On wheels: `velocity[0]` forward, and a turn rate. Flying: a velocity in W.
struct Motion {
  std::array<double, 3> velocity{};
  double turn_rad_s = 0.0;
  friend bool operator==(const Motion&, const Motion&) = default;
};

/// What is to be known of a robot's body.
struct MotionLimits {
  double radius_m = 0.0, height_m = 0.0;
  double wheel_base_m = 0.0;  ///< 0: it flies, or stays
  double settle_s = 0.0;      ///< until it moves as a new command says, whatever it got before
};
MotionLimits motion_limits(const hal::RobotKind& kind) noexcept;

/// A robot's commands of late. The oldest are merged where there are more than it holds.
class CommandTrail {
 public:
  static constexpr std::size_t kMost = 48;
  struct Told {
    hal::TimeNs from_ns = 0;
    Motion low, high;
  };

  void note(hal::TimeNs sent_ns, const Motion& motion) noexcept;
  /// What ended before cannot matter any more.
  void forget(hal::TimeNs before_ns) noexcept;

  std::size_t size() const noexcept { return count_; }
  const Told& operator[](std::size_t i) const noexcept { return told_[i]; }

 private:
  std::array<Told, kMost> told_;
  std::size_t count_ = 0;
};

/// How far a robot may come in a direction, from where it was when its pose was taken, until it stands: when it is told
/// something now, and from the next tick on to stand.
///
///   bound.begin(…); bound.turn(…); bound.look(direction); bound.way_m(speed) <= budget_m
///
/// The speed is that of the wheels forward (negative: backward), or of a flight in that direction.
class MotionBound {
 public:
  struct Times {
    hal::TimeNs pose_ns = 0, now_ns = 0;
    hal::TimeNs tick_ns = 0;  ///< until the next command, at most
    double reaction_s = 0.0;
  };
  void begin(const CommandTrail& trail, const Times& times, bool on_wheels) noexcept;
  /// Of a robot on wheels: its heading is known so well, and it is ordered to turn so fast.
  void turn(const hal::Pose& pose, double error_rad, double turn_rad_s) noexcept;
  /// A direction of length 1: level, or straight up or down.
  void look(const std::array<double, 3>& direction) noexcept;

  /// Grows with the speed's magnitude. Never negative: it may stand.
  double way_m(double speed_m_s) const noexcept;
  /// The largest part of a speed with at most this way; 0 where even standing has more.
  double most_m_s(double speed_m_s, double budget_m) const noexcept;
  /// The part of it that is the new command's alone: 0 of one that leaves.
  double own_way_m(double speed_m_s) const noexcept;
  /// The farthest that it can come in any direction, when its speed is this at most.
  double farthest_m(double speed_m_s) const noexcept;

 private:
  struct Slice {
    double span_s = 0.0;
    bool now = false;                                      // the new command may move it
    Motion low, high;                                      // of the earlier ones that may
    double turned_right_rad = 0.0, turned_left_rad = 0.0;  // since the pose, at most
    // In the direction that is looked at: way for each m/s forward and backward, and speed by earlier commands.
    double ahead_s = 0.0, back_s = 0.0, ahead_m_s = 0.0, back_m_s = 0.0;
  };

  std::array<Slice, CommandTrail::kMost + 3> slices_;
  std::size_t count_ = 0;
  bool on_wheels_ = true;
  double heading_rad_ = 0.0;
};

}  // namespace tandem::mixed_reality
