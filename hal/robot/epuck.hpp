// The e-puck, versions 1 and 2.
#pragma once
#include "hal/robot_kind.hpp"

namespace tandem::hal::epuck {

inline constexpr std::string_view kName = "e-puck";

const RobotKind& kind();

}  // namespace tandem::hal::epuck
