// The e-puck2: an e-puck with a faster processor, more sensors and a radio.
#pragma once
#include "hal/robot_kind.hpp"

namespace tandem::hal::epuck2 {

inline constexpr std::string_view kName = "e-puck2";

const RobotKind& kind();

}  // namespace tandem::hal::epuck2
