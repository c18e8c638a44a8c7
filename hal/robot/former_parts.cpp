#include "hal/robot/former_parts.hpp"

#include "hal/device/gripper.hpp"
#include "hal/device/leds.hpp"
#include "hal/device/turret.hpp"

namespace tandem::hal {

void add_former_parts(RobotKind& kind, const std::function<double(const char*)>& said, std::vector<Mount> leds) {
  const double reach_m = said("gripper_reach");
  const bool turn = said("leds_on_turret") != 0.0;
  if (turn || reach_m > 0.0) kind.add(TurretPart{});
  if (reach_m > 0.0) kind.add(GripperPart{.reach_m = reach_m});
  if (!leds.empty()) kind.add(LedsPart{.on_turret = turn, .mounts = std::move(leds)});
}

}  // namespace tandem::hal
