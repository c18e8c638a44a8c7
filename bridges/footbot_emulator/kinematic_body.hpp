// A body with a little world of its own: two wheels on level ground, perhaps in a rectangular arena.
#pragma once
#include <optional>
#include <utility>

#include "bridges/body_pose.hpp"
#include "bridges/emulation/imperfect_wheels.hpp"
#include "bridges/footbot_emulator/body.hpp"

namespace tandem::bridges::footbot_emulator {

/// An arena with walls, centred on the origin.
struct Arena {
  double length_x_m = 2.0;
  double length_y_m = 2.0;
};

using Pose = BodyPose;

/// Differential drive [Siegwart 2011, section 3.2] on wheels that may err; a wall stops the body, and it slides along.
/// Turret, scanner and claws turn at their speeds. There is nothing to grip: claws that were opened are busy for a
/// second, try their grip, and are closed again. Moves only when a call tells it a later time. One thread at a time.
class KinematicBody final : public EmulatedBody {
 public:
  explicit KinematicBody(const Pose& start = {}, const std::optional<Arena>& arena = {},
                         const WheelErrors& errors = {});

  /// Goes on to `now`.
  void advance(hal::TimeNs now);
  BodySenses sense(hal::TimeNs now) override;
  void actuate(hal::TimeNs now, const BodyCommand& command) override;
  std::vector<Heard> take_heard() override { return std::exchange(heard, {}); }

  const Pose& pose() const noexcept { return pose_; }
  /// Somebody puts it elsewhere: moved in the frame of the world, and turned.
  void carry(hal::TimeNs now, double x_m, double y_m, double turn_rad);
  /// Something holds it: its wheels turn, and it does not move.
  void hold(hal::TimeNs now, bool held);
  const BodyCommand& command() const noexcept { return command_; }
  /// What the senses are where the arena says nothing: ground, light, battery …
  BodySenses surroundings;
  /// What the radio is to hear next.
  std::vector<Heard> heard;

 private:
  void roll(hal::TimeNs until);
  void turn_devices(hal::TimeNs until, double dt_s);
  double distance_to_wall_m(double x_m, double y_m, double direction_rad) const;

  Pose pose_;
  std::optional<Arena> arena_;
  ImperfectWheels wheels_;
  BodyCommand command_;
  std::optional<hal::TimeNs> at_;
  double turret_rad_ = 0.0;
  double scanner_rad_ = 0.0;
  double gripper_rad_ = 0.0;
  hal::TimeNs grip_tried_at_ = 0;
  bool trying_grip_ = false;
  bool gave_up_ = false;  // the claws were closed again
  bool held_ = false;
};

}  // namespace tandem::bridges::footbot_emulator
