// Displays and files of `tandem robot`: a record, a table on the terminal, a window. A robot's board has none of them.
#pragma once
#include <functional>
#include <memory>
#include <string_view>
#include <utility>
#include <vector>

#include "app/real/lone_robot.hpp"
#include "bridges/robot_bridge.hpp"
#include "core/run/run.hpp"
#include "core/scenario/scenario.hpp"
#include "hal/command.hpp"
#include "hal/controller.hpp"
#include "hal/json/json.hpp"
#include "hal/plugin_loader.hpp"
#include "hal/published.hpp"
#include "hal/result.hpp"

namespace tandem::mixed_reality {
class LoneRobot;
}

namespace tandem::app {

/// A robot and its controller, which outlive their displays.
struct ShownRobot {
  const core::Scenario& scenario;
  hal::PluginLoader& loader;
  const core::RobotItem& item;
  bridges::RobotBridge& bridge;
  const hal::ControllerType& type;
  void* controller = nullptr;
  std::vector<std::pair<hal::PublishedField, const void*>> published;  ///< with the members of the controller
  /// What people command: "estop", "arm", "rearm"; on any thread. Error: nothing else can be done.
  std::function<hal::Status(std::string_view command)> obey;
};

/// Their options.
void describe_robot_sinks(hal::CommandLine& line, RobotOptions& options);

/// As parts of the robot's run; none: none is asked for. After the controller has taken its ports and before the
/// bridge starts. What `shown` refers to, and `lone`, outlive them. `end`: what a record says at its
/// end. Error: no window can be opened.
using RobotSinks = std::vector<std::unique_ptr<core::RunPart>>;
hal::Result<RobotSinks> robot_sinks(const RobotOptions& options, const ShownRobot& shown,
                                    const mixed_reality::LoneRobot& lone, std::function<hal::Json()> end);

}  // namespace tandem::app
