// The Thymio II, a robot for schools.
#pragma once
#include "hal/robot_kind.hpp"

namespace tandem::hal::thymio {

inline constexpr std::string_view kName = "thymio";

/// LEDs in the order of `RingLeds`: the circle around the buttons, the two below, the one on top.
inline constexpr std::size_t kCircleLeds = 8;
inline constexpr std::size_t kBottomLeft = 8, kBottomRight = 9, kTop = 10;

const RobotKind& kind();
/// The look of body and wheels.
LookPart shell();

}  // namespace tandem::hal::thymio
