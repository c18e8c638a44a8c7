// The eye-bot as its controller sees it: ports that the driver fills and drains.
#pragma once
#include "bridges/bridged_robot.hpp"
#include "hal/robot/eyebot.hpp"

namespace tandem::bridges::eyebot {

/// Every port class that an eye-bot has: sensors first. Range-and-bearing and distance scanner are in both halves.
const std::vector<const hal::PortType*>& port_types();

class EyebotRobot final : public BridgedRobot {
 public:
  explicit EyebotRobot(RobotSettings settings)
      : BridgedRobot("eye-bot", hal::eyebot::kind(), std::move(settings), port_types()) {
    never_had = " that can be reached over LCM";
  }
};

}  // namespace tandem::bridges::eyebot
