#include "app/driven_robot.hpp"

#include "hal/spec/epuck.hpp"
#include "hal/spec/eyebot.hpp"
#include "hal/spec/footbot.hpp"

namespace tandem::app {

std::vector<std::string> device_names(const std::vector<core::DeviceChoice>& choices) {
  std::vector<std::string> names;
  for (const core::DeviceChoice& c : choices) names.push_back(c.device);
  return names;
}

hal::Result<std::unique_ptr<DrivenRobot>> make_driven_robot(const DrivenRobotRequest& request, const hal::Log& log) {
  if (request.item.kind == hal::epuck::kDataSheet.kind) return make_driven_epuck(request, log);
  if (request.item.kind == hal::footbot::kDataSheet.kind) return make_driven_footbot(request, log);
  if (request.item.kind == hal::eyebot::kDataSheet.kind) return make_driven_eyebot(request, log);
  return hal::Error{"there is no bridge to robots of the kind '" + request.item.kind +
                    "'; there is: e-puck, foot-bot, eye-bot"};
}

}  // namespace tandem::app
