// Joints: how devices and hooks have engines hold two bodies together.
#pragma once
#include <array>
#include <cstdint>

#include "core/scenario/engine_traits.hpp"
#include "core/space/body_key.hpp"

namespace tandem::core {

/// Form of a joint: its type, motor and limits. Angles of turning joints are headings of b relative to a; places of
/// sliding ones are how far b's point lies from a's, along the axis.
struct JointForm {
  JointKind kind = JointKind::Fixed;
  /// Sliding: unit vector along which b slides. In W for makers of joints, in a's frame in the stores. Engines of
  /// the plane take what of it lies in the plane; what slides upwards is fixed there.
  std::array<double, 3> axis{};
  bool limited = false;
  double low = 0.0, high = 0.0;  ///< where it is limited: rad or m, low <= high
  double motor_most = 0.0;       ///< N m or N with which a motor drives b, at most; 0: none
  double motor_speed = 0.0;      ///< rad/s or m/s that the motor strives for; may change without a new generation
};

/// Two bodies held together. Both are moved by the engine of the one that sorts first, wherever they are.
struct Joint {
  bool alive = false;
  std::uint32_t generation = 0;
  BodyKey a, b;
  double ax_m = 0.0, ay_m = 0.0, az_m = 0.0;  ///< where, in a's frame: from its centre, z from its base
  double bx_m = 0.0, by_m = 0.0, bz_m = 0.0;  ///< the same point in b's frame; where it slides: at place 0
  double heading_rad = 0.0;                   ///< of b relative to a, where it may not turn
  JointForm form;
};

}  // namespace tandem::core
