// Parts of kinds as records from before the second protocol of frames describe them.
#pragma once
#include <functional>
#include <vector>

#include "hal/robot_kind.hpp"

namespace tandem::hal {

/// `said` gives the number that such a record has under a key, 0 where it has none.
void add_former_parts(RobotKind& kind, const std::function<double(const char*)>& said, std::vector<Mount> leds);

}  // namespace tandem::hal
