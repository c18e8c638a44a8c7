// One foot-bot without threads (bridges/aseba/node_driver.hpp): its map, and the wiring of its ports by it.
//
// Modules have no watchdog: when the link is cut while the robot moves, it drives on until the link is back; when this
// process is killed, until a guardian (bridges/guardian), where one was started, stops it. The remedy is the program
// that the map gives the motors' modules (<dead_man>, bridges/aseba/dead_man.hpp): it sets the speed to 0 when it was
// told nothing for a while.
#pragma once
#include "bridges/aseba/node_driver.hpp"
#include "bridges/footbot/wiring.hpp"

namespace tandem::bridges::footbot {

using aseba::RobotState;
using aseba::state_name;
using DriverStatistics = aseba::NodeDriverStatistics;

struct DriverSettings : aseba::NodeDriverSettings {
  FootbotMap map = {};
};

struct FootbotParts {
  using Settings = DriverSettings;
  using Robot = FootbotRobot;
  using Wiring = footbot::Wiring;
  static constexpr std::string_view kNoun = "foot-bot";
  static constexpr std::string_view kKind = hal::footbot::kName;
  static constexpr std::string_view kAdvice =
      "is it switched on, and are its nodes and their variables called as in the map?";
  static std::string name_on_link(const Settings&) { return ""; }
  static Robot make_robot(const Settings& settings) { return Robot(settings.robot, settings.map); }
  static Wiring make_wiring(const Settings& settings, aseba::Network& network, Robot& robot) {
    return Wiring(settings.map, network, robot, settings.observe);
  }
};

using FootbotDriver = aseba::NodeDriver<FootbotParts>;

}  // namespace tandem::bridges::footbot
