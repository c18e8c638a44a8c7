// One Thymio without threads (bridges/aseba/node_driver.hpp): its program, and the wiring of its ports.
//
// The program in the robot stops it when it heard nothing of the hub for the command time-out, whatever has become of
// hub, guardian and link. Only when the program itself is gone, by the loading of another, does the robot do
// as that one says.
#pragma once
#include "bridges/aseba/node_driver.hpp"
#include "bridges/thymio/wiring.hpp"

namespace tandem::bridges::thymio {

using aseba::RobotState;
using aseba::state_name;

struct DriverSettings : aseba::NodeDriverSettings {
  Calibration calibration = {};
};

struct ThymioParts {
  using Settings = DriverSettings;
  using Robot = ThymioRobot;
  using Wiring = thymio::Wiring;
  static constexpr std::string_view kNoun = "Thymio";
  static constexpr std::string_view kKind = hal::thymio::kName;
  static constexpr std::string_view kAdvice =
      "is it switched on, and plugged in or linked by its dongle, and does nobody else hold the line?";
  static std::string name_on_link(const Settings& settings) {
    const int node = settings.calibration.node;
    return node == 0 ? "" : "node " + std::to_string(node);
  }
  static constexpr hal::TimeNs kGrace = 200 * hal::kNsPerMs;
  static Robot make_robot(const Settings& settings) { return Robot(settings.robot); }
  /// The robot stops by itself a little after the driver would have stopped it, had it been able to.
  static Wiring make_wiring(const Settings& settings, aseba::Network& network, Robot& robot) {
    Calibration calibration = settings.calibration;
    calibration.alive_ns = settings.command_timeout_ns + kGrace;
    return Wiring(calibration, network, robot, settings.observe);
  }
};

using ThymioDriver = aseba::NodeDriver<ThymioParts>;

}  // namespace tandem::bridges::thymio
