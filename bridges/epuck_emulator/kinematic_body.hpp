// A body with a little world of its own: two wheels on level ground, perhaps in a rectangular arena.
#pragma once
#include <optional>

#include "bridges/body_pose.hpp"
#include "bridges/emulation/imperfect_wheels.hpp"
#include "bridges/epuck_emulator/body.hpp"

namespace tandem::bridges::epuck_emulator {

/// An arena with walls, centred on the origin.
struct Arena {
  double length_x_m = 1.0;
  double length_y_m = 1.0;
};

using Pose = BodyPose;

/// Differential drive [Siegwart 2011, section 3.2] on wheels that may err; a wall stops the body, and it slides along.
/// Moves only when a call tells it a later time. One thread at a time.
class KinematicBody final : public EmulatedBody {
 public:
  explicit KinematicBody(const Pose& start = {}, const std::optional<Arena>& arena = {},
                         const WheelErrors& errors = {});

  /// Rolls on to `now`.
  void advance(hal::TimeNs now);
  BodySenses sense(hal::TimeNs now) override;
  void actuate(hal::TimeNs now, const BodyCommand& command) override;

  const Pose& pose() const noexcept { return pose_; }
  const BodyCommand& command() const noexcept { return command_; }
  /// What the senses are where the arena says nothing: ground, light, battery …
  BodySenses surroundings;

 private:
  void roll(hal::TimeNs until);
  double distance_to_wall_m(double x_m, double y_m, double direction_rad) const;

  Pose pose_;
  std::optional<Arena> arena_;
  ImperfectWheels wheels_;
  BodyCommand command_;
  std::optional<hal::TimeNs> at_;
};

}  // namespace tandem::bridges::epuck_emulator
