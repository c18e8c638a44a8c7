// Body of any emulated robot on two wheels, in a little world of its own: level ground, perhaps with walls around it.
#pragma once
#include <optional>
#include <span>

#include "bridges/body_pose.hpp"
#include "bridges/emulation/imperfect_wheels.hpp"
#include "hal/robot_kind.hpp"

namespace tandem::bridges {

/// A rectangle of walls, centred on the origin.
struct Arena {
  double length_x_m = 1.0, length_y_m = 1.0;

  /// From a place inside to the wall in that direction.
  double distance_m(double x_m, double y_m, double direction_rad) const;
};

/// The angle that a device has reached which turns the shorter way to `target_rad`, by `most_rad` at the most.
double turned_towards(double angle_rad, double target_rad, double most_rad) noexcept;

/// Differential drive [Siegwart 2011, section 3.2] on wheels that may err; a wall stops the body, and it slides along.
/// Moves only when a call tells it a later time; times never go back. One thread at a time.
class WheeledBody {
 public:
  /// `kind` has two wheels, and outlives this.
  WheeledBody(const hal::RobotKind& kind, const BodyPose& start, const std::optional<Arena>& arena,
              const WheelErrors& errors)
      : kind_(kind), pose_(start), arena_(arena), wheels_(errors) {}

  /// Rolls on to `now`.
  void advance(hal::TimeNs now);
  /// The firmware has its wheels turn like this, from `now` on.
  void tell(hal::TimeNs now, double left_m_s, double right_m_s);
  /// It is put elsewhere: moved in the frame of the world, and turned.
  void carry(hal::TimeNs now, double x_m, double y_m, double turn_rad);
  /// Something holds it: its wheels turn, and it does not move.
  void hold(hal::TimeNs now, bool held);

  /// As of the last call that told a time.
  const BodyPose& pose() const noexcept { return pose_; }
  double turn_rad_s() const noexcept;
  /// From a place in the body's frame to the wall in a direction of the world's; infinite without an arena.
  double free_m(double x_B_m, double y_B_m, double direction_rad) const;
  /// Shortens what the kind's infrared sensors see to the walls; does nothing without an arena.
  void see_walls(std::span<double> distance_m) const;

 private:
  void roll(hal::TimeNs until);

  const hal::RobotKind& kind_;
  BodyPose pose_;  // taken when it last rolled
  std::optional<Arena> arena_;
  ImperfectWheels wheels_;
  std::optional<hal::TimeNs> at_;
  bool held_ = false;
};

/// The same as the body of one firmware: `kind` is its robot, `Interface` an EmulatedBodyOf.
template <class Interface, const hal::RobotKind& (*kind)()>
class WheeledBodyOf : public Interface, public WheeledBody {
 public:
  explicit WheeledBodyOf(const BodyPose& start = {}, const std::optional<Arena>& arena = {},
                         const WheelErrors& errors = {})
      : WheeledBody(kind(), start, arena, errors) {}

  typename Interface::Senses sense(hal::TimeNs now) override {
    advance(now);
    typename Interface::Senses senses = surroundings;
    look(senses);
    return senses;
  }
  void actuate(hal::TimeNs now, const typename Interface::Command& command) override {
    tell(now, command.left_m_s, command.right_m_s);
    command_ = command;
  }
  const typename Interface::Command& command() const noexcept { return command_; }

  /// What the senses are where the arena says nothing: ground, light, battery …
  typename Interface::Senses surroundings;

 protected:
  /// What body and arena change in them.
  virtual void look(typename Interface::Senses& senses) const { see_walls(senses.distance_m); }

 private:
  typename Interface::Command command_;
};

}  // namespace tandem::bridges
