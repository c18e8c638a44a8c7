// The part of an eye-bot's firmware that steers: from a mode and a setpoint to a velocity.
#pragma once
#include <optional>

#include "bridges/eyebot_emulator/body.hpp"
#include "bridges/eyebot_emulator/supervisor.hpp"

namespace tandem::bridges::eyebot_emulator {

/// A box that the robot must not leave, centred on the origin.
struct Fence {
  double half_x_m = 50.0;
  double half_y_m = 50.0;
  double top_m = 20.0;

  bool contains(const Vec3& p_W) const noexcept;
  /// The nearest place that is `margin_m` inside.
  Vec3 nearest_inside(const Vec3& p_W, double margin_m) const noexcept;
};

struct Guidance {
  Vec3 velocity_m_s{};  ///< in W
  double yaw_rad_s = 0.0;
};

/// Remembers the setpoint. Speeds are limited to those of the kind.
class Pilot {
 public:
  explicit Pilot(const Fence& fence) : fence_(fence) {}

  /// Where to fly; `here` resolves what is relative to the body. Errors: the place is outside of the fence, the frame
  /// is none.
  Answer go_to(const PositionCommand& command, const BodySenses& here);
  /// How to fly. Errors: the frame is none.
  Answer fly(const VelocityCommand& command);
  /// Hovers where it can come to rest, inside the fence.
  void stay(const BodySenses& here);

  Guidance guide(const Supervisor& supervisor, const BodySenses& here) const;

 private:
  Guidance towards_target(const BodySenses& here) const;

  Fence fence_;
  Vec3 target_{};
  std::optional<double> yaw_rad_{};
  double most_m_s_ = robot_part<hal::Quadrotor>().max_speed_m_s;
  VelocityCommand velocity_{};
};

}  // namespace tandem::bridges::eyebot_emulator
