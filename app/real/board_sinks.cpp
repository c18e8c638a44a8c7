// A robot's board has no space, and so nothing that shows one.
#include "app/real/robot_sinks.hpp"

namespace tandem::app {

void describe_robot_sinks(hal::CommandLine& /*line*/, RobotOptions& /*options*/) {}

hal::Result<RobotSinks> robot_sinks(const RobotOptions& /*options*/, const ShownRobot& /*shown*/,
                                    const mixed_reality::LoneRobot& /*lone*/, std::function<hal::Json()> /*end*/) {
  return RobotSinks{};
}

}  // namespace tandem::app
