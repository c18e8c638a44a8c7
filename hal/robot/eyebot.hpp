// The eye-bot, the flying robot of the Swarmanoid project [Dorigo et al. 2013, "Swarmanoid", IEEE Robotics & Automation
// Magazine 20(4)].
#pragma once
#include "hal/robot_kind.hpp"

namespace tandem::hal::eyebot {

inline constexpr std::string_view kName = "eye-bot";

const RobotKind& kind();
/// The look of body and rotors.
LookPart shell();

}  // namespace tandem::hal::eyebot
