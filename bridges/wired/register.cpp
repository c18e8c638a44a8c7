#include "bridges/wired/register.hpp"

#include "bridges/wired/wired_line.hpp"
#include "hal/robot/epuck.hpp"
#include "hal/robot/footbot.hpp"

namespace tandem::bridges::wired {
namespace {

const WiredType kEpuck{.name = hal::epuck::kName,
                       .summary = "emulated, or emulated:FIRMWARE (btcom, gctronic, webots, epuck2)",
                       .make = &make_wired_epuck};
const WiredType kFootbot{.name = hal::footbot::kName,
                         .summary = "emulated:MAP, the file that its <bridge> would name",
                         .make = &make_wired_footbot};

}  // namespace

void register_wired_robots(hal::Registrar& registrar) {
  registrar.add(kEpuck);
  registrar.add(kFootbot);
}

}  // namespace tandem::bridges::wired
