// Changes commands of real robots by as little as keeps them from collisions, in their fences and out of keep-outs.
//
//   each tick:  robot.wanted = …, robot.pose = … for every robot;  filter.solve(now);  robot.allowed;
//   robot.note_sent(…)
//
// A discrete-time control barrier. Of two bodies let h be the gap between them in some direction, less how far both can
// still come in it before they stand (MotionBound). A command is allowed when h stays at or above 0 although it is
// followed: then there is always a next one, which is to stand, that keeps h there. Each of two real robots gets half
// of what is left, and what the other one does not need. Robots on wheels keep the turn that was wanted: it moves no
// part of an upright cylinder's outline; of their forward speed the nearest allowed is taken. Of flights, the nearest
// velocity (PlaneProgram).
#pragma once
#include <array>
#include <cstdint>
#include <memory>
#include <vector>

#include "core/scenario/scenario.hpp"
#include "hal/time.hpp"
#include "mixed_reality/barrier/motion_bound.hpp"
#include "mixed_reality/barrier/plane_program.hpp"

namespace tandem::mixed_reality {

/// A point of something that no robot of this filter moves: its nearest to the robot.
struct Obstacle {
  double x_m = 0.0, y_m = 0.0;
  double beyond_m = 0.0;          ///< its outline lies so far from the point, towards the robot: a disc's radius
  std::array<double, 2> v_m_s{};  ///< of the point
};

/// Deepest place where a robot is that it should not be.
struct Trespass {
  const core::SafetyArea* area = nullptr;  ///< null: none
  bool out_of_fence = false;               ///< else in a keep-out
  double depth_m = 0.0;                    ///< of its body
};

/// One real robot. `solve` reads the first part and writes the second.
struct BarrierRobot {
  explicit BarrierRobot(const hal::RobotKind& kind) noexcept
      : limits(motion_limits(kind)), flies(kind.flies()), moves(kind.flies() || kind.drive() != nullptr) {}

  MotionLimits limits;
  bool flies, moves;
  bool placed = false;                    ///< its pose means something
  hal::Pose pose;                         ///< as it was measured
  hal::TimeNs pose_ns = 0;                ///< when; monotonic, as all times here
  double error_m = 0.0, error_rad = 0.0;  ///< by which the pose is wrong, at most
  double latency_s = 0.0;
  bool hears = true;  ///< false: it goes on by its last command, whatever it gets
  Motion wanted;
  std::vector<Obstacle> obstacles;

  Motion allowed;
  double changed_m_s = 0.0;  ///< by how much `allowed` differs
  Trespass trespass;

  /// What was handed to it in the end.
  void note_sent(hal::TimeNs sent_ns, const Motion& motion) noexcept { trail.note(sent_ns, motion); }

  // For the filter.
  CommandTrail trail;
  MotionBound bound;
  PlaneProgram plane;
  double most_m_s = 0.0;  // of the wheels' forward speed, its magnitude
  double up_m_s = 0.0, down_m_s = 0.0, zone_m_s = 0.0;
  double reach_m = 0.0, up_m = 0.0;  // how far it may come
  double down_m = 0.0;
};

class BarrierFilter {
 public:
  static constexpr hal::TimeNs kLate_ns = 10 * hal::kNsPerMs;  ///< by which a tick may be late

  /// Ticks come every `tick_ns`. The settings must outlive this.
  BarrierFilter(const core::SafetyConfig& settings, hal::TimeNs tick_ns) : settings_(settings), tick_ns_(tick_ns) {}

  /// The address stays.
  BarrierRobot& add(const hal::RobotKind& kind);
  void remove(const BarrierRobot& robot);

  const core::SafetyConfig& settings() const noexcept { return settings_; }
  /// Allocates nothing.
  void solve(hal::TimeNs now_ns) noexcept;

 private:
  using Direction = std::array<double, 3>;

  void begin(BarrierRobot& robot, hal::TimeNs now_ns) const noexcept;
  void keep_apart(BarrierRobot& a, BarrierRobot& b, Direction& last) const noexcept;
  void keep_from(BarrierRobot& robot, const Obstacle& obstacle) const noexcept;
  void keep_in(BarrierRobot& robot, const core::SafetyArea& fence) const noexcept;
  void keep_out(BarrierRobot& robot, const core::SafetyArea& area) const noexcept;
  void keep_slow(BarrierRobot& robot, const core::SafetyArea& zone) const noexcept;
  void keep_from_sides(BarrierRobot& robot, const core::SafetyArea& area) const noexcept;
  void decide(BarrierRobot& robot) const noexcept;
  double body_m(const BarrierRobot& robot) const noexcept {
    return robot.limits.radius_m + robot.error_m + settings_.apart_m;
  }

  const core::SafetyConfig& settings_;
  hal::TimeNs tick_ns_;
  std::vector<std::unique_ptr<BarrierRobot>> robots_;
  std::vector<Direction> last_;  // of the pairs (i, k), i < k, in which they were kept apart
};

}  // namespace tandem::mixed_reality
