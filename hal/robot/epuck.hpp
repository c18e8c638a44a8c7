// The e-puck, and what an e-puck2 has in common with it.
#pragma once
#include "hal/robot_kind.hpp"

namespace tandem::hal::epuck {

inline constexpr std::string_view kName = "e-puck";

const RobotKind& kind();
/// The camera under a mirror that some e-pucks carry on a mast.
const ExtraPart& omnidirectional_camera();
/// The board of ARGoS' separate plug-in, whose messages have 4 bytes.
const ExtraPart& range_and_bearing();
/// The look of body and wheels.
LookPart shell();

}  // namespace tandem::hal::epuck
