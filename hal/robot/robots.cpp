#include "hal/robot/robots.hpp"

#include "hal/robot/epuck.hpp"
#include "hal/robot/epuck2.hpp"
#include "hal/robot/eyebot.hpp"
#include "hal/robot/footbot.hpp"
#include "hal/robot/shell.hpp"
#include "hal/robot/thymio.hpp"

namespace tandem::hal {

void register_robots(Registrar& registrar) {
  for (const RobotKind* kind : {&epuck::kind(), &epuck2::kind(), &eyebot::kind(), &footbot::kind(), &thymio::kind()})
    registrar.add(*kind);
  registrar.add(epuck::omnidirectional_camera());
  registrar.add(epuck::range_and_bearing());
  registrar.add(part_type<ShellPart>());
}

}  // namespace tandem::hal
