// Virtual things near a real robot, for those that keep it from running into them.
#pragma once
#include <vector>

#include "core/space/space.hpp"
#include "mixed_reality/barrier/barrier_filter.hpp"

namespace tandem::mixed_reality {

/// Boxes, cylinders and simulated robots at the height of `robot` at `pose` whose outlines are within `within_m` of its
/// own: as many as `out` has room for, which is not made larger. Those that it stands in are left out (intrusion_of).
void find_obstacles(const core::Space& space, core::RobotId robot, const core::Pose& pose, double within_m,
                    std::vector<Obstacle>& out) noexcept;

}  // namespace tandem::mixed_reality
