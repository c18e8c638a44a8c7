// Displays and files of `tandem robot`: a record, a table on the terminal. A robot's board has neither.
#pragma once
#include <functional>
#include <memory>
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

namespace tandem::mixed_reality {
class LoneRobot;
}

namespace tandem::app {

/// A robot and its controller, which outlive their displays.
struct ShownRobot {
  const core::Scenario& scenario;
  const hal::PluginLoader& loader;
  const core::RobotItem& item;
  bridges::RobotBridge& bridge;
  const hal::ControllerType& type;
  void* controller = nullptr;
  std::vector<std::pair<hal::PublishedField, const void*>> published;  ///< with the members of the controller
};

/// Their options.
void describe_robot_sinks(hal::CommandLine& line, RobotOptions& options);

/// As a part of the robot's run; null: none is asked for. After the controller has taken its ports and before the
/// bridge starts. What `shown` refers to, and `lone`, outlive the part. `end`: what a record says at
/// its end.
std::unique_ptr<core::RunPart> robot_sinks(const RobotOptions& options, const ShownRobot& shown,
                                           const mixed_reality::LoneRobot& lone, std::function<hal::Json()> end);

}  // namespace tandem::app
