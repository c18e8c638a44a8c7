// A body with a little world of its own: a mass point with a heading above level ground, perhaps beneath a ceiling.
#pragma once
#include <utility>

#include "bridges/eyebot_emulator/body.hpp"

namespace tandem::bridges::eyebot_emulator {

/// A room with walls, centred on the origin, with its floor at height 0.
struct Room {
  double length_x_m = 40.0;
  double length_y_m = 40.0;
  double height_m = 5.0;
};

/// In W.
struct Start {
  Vec3 p_WB{};
  double yaw_rad = 0.0;
};

/// Follows the commanded velocity with the kind's greatest acceleration while the motors run, and falls while
/// they do not. Ground, ceiling and walls stop it without a bounce; the magnet holds it where its top touches the
/// ceiling. It leans as its acceleration asks: thrust along the body's z axis. Scanner, pan and tilt turn at speeds of
/// their own. Moves only when a call tells it a later time, in steps of 10 ms. One thread at a time.
class PointBody final : public EmulatedBody {
 public:
  explicit PointBody(const Start& start = {}, const std::optional<Room>& room = {});

  /// Goes on to `now`.
  void advance(hal::TimeNs now);
  BodySenses sense(hal::TimeNs now) override;
  void actuate(hal::TimeNs now, const BodyCommand& command) override;
  std::vector<Heard> take_heard() override { return std::exchange(heard, {}); }

  const BodyCommand& command() const noexcept { return command_; }
  /// How fast it came down on the ground the last time; 0 before.
  double touched_m_s() const noexcept { return touched_m_s_; }
  /// What the senses are where the room says nothing: light, blobs …
  BodySenses surroundings;
  /// What the radio is to hear next.
  std::vector<Heard> heard;

 private:
  void move(double dt_s);
  void turn_devices(double dt_s);
  double distance_to_wall_m(double direction_rad, double offset_m) const;
  double top_m() const { return p_[2] + robot_part<hal::Body>().height_m; }
  bool held() const;

  std::optional<Room> room_;
  BodyCommand command_;
  std::optional<hal::TimeNs> at_;
  Vec3 p_{};
  Vec3 v_{};
  Vec3 a_{};
  double yaw_rad_ = 0.0;
  double scanner_rad_ = 0.0;
  double pan_rad_ = 0.0;
  double tilt_rad_ = 0.0;
  double touched_m_s_ = 0.0;
};

}  // namespace tandem::bridges::eyebot_emulator
