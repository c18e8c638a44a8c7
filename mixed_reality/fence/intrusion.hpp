// Virtual things that a real robot drives into: nothing there holds it back but its commands.
#pragma once
#include <string>

#include "core/space/space.hpp"

namespace tandem::mixed_reality {

/// A robot's twin stands in something.
struct Intrusion {
  static constexpr double kTouch_m = 0.01;  ///< less deep is a touch

  double depth_m = 0.0;             ///< of its body in the other; 0: nowhere
  double out_x = 0.0, out_y = 0.0;  ///< the shortest way out, in W, of length 1
  core::ObjectId object;            ///< what it stands in …
  core::RobotId robot;              ///< … or who

  bool deep() const noexcept { return depth_m > kTouch_m; }
};

/// The deepest of `robot` at `pose` in boxes, cylinders and simulated robots at its height. Twins of real robots do not
/// count: real ones cannot stand in one another.
Intrusion intrusion_of(const core::Space& space, core::RobotId robot, const core::Pose& pose) noexcept;
/// Its id, for people.
std::string name_of(const core::Space& space, const Intrusion& intrusion);

}  // namespace tandem::mixed_reality
