// The e-puck, and what an e-puck2 has in common with it.
#pragma once
#include "hal/robot_kind.hpp"

namespace tandem::hal::epuck {

inline constexpr std::string_view kName = "e-puck";

const RobotKind& kind();
/// What body and wheels look like.
LookPart shell();

}  // namespace tandem::hal::epuck
