// The foot-bot as its controller sees it: ports that the wiring fills and drains.
#pragma once
#include <vector>

#include "bridges/aseba/node_driver.hpp"
#include "bridges/footbot/map.hpp"
#include "hal/device/distance_scanner.hpp"
#include "hal/robot/footbot.hpp"

namespace tandem::bridges::footbot {

/// Every port class that a foot-bot's map may feed: sensors first. Range-and-bearing is in both halves.
const std::vector<const hal::PortType*>& port_types();

/// Ports of one foot-bot: those that the map feeds, the clock, and the odometry where the wheels' encoders are fed.
class FootbotRobot final : public aseba::NodeRobot {
 public:
  FootbotRobot(RobotSettings settings, const FootbotMap& map);

  /// Clock and odometry, where the scanner's heads look, whether the gripper holds.
  void complete(hal::Tick tick) noexcept;

 private:
  const hal::ScannerPart* heads_;  // null: it has no scanner
  bool tells_holding_ = false;     // the map does
};

}  // namespace tandem::bridges::footbot
