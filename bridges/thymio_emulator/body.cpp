#include "bridges/thymio_emulator/body.hpp"

#include <algorithm>

#include "bridges/emulation/true_pose.hpp"
#include "hal/robot/thymio.hpp"

namespace tandem::bridges::thymio_emulator {

void OpenGround::advance(hal::TimeNs now) {
  constexpr hal::TimeNs kStepNs = 10 * hal::kNsPerMs;  // over which noise, floor and a late wheel are looked at
  if (pose_.taken_ns == 0 || wheels_.still()) pose_.taken_ns = std::max(pose_.taken_ns, now);
  const bool by_steps = wheels_.errors().any();
  while (pose_.taken_ns < now) {
    const hal::TimeNs until = by_steps ? std::min(now, pose_.taken_ns + kStepNs) : now;
    const ImperfectWheels::Ways ways = wheels_.roll(pose_.taken_ns, until, pose_.x_m, pose_.y_m);
    pose_ = rolled(pose_, ways.left_m, ways.right_m, wheels_.errors().base * hal::thymio::kind().drive()->wheel_base_m);
    pose_.taken_ns = until;
  }
}

}  // namespace tandem::bridges::thymio_emulator
