// The foot-bot, the Swarmanoid project's configuration of the marXbot [Bonani et al. 2010, "The marXbot, a miniature
// mobile robot opening new perspectives for the collective-robotic research", IROS].
#pragma once
#include "hal/robot_kind.hpp"

namespace tandem::hal::footbot {

inline constexpr std::string_view kName = "foot-bot";

const RobotKind& kind();
/// The look of body and wheels.
LookPart shell();

}  // namespace tandem::hal::footbot
