#include "bridges/thymio_emulator/body.hpp"

#include "bridges/emulation/true_pose.hpp"
#include "hal/robot/thymio.hpp"

namespace tandem::bridges::thymio_emulator {

void OpenGround::advance(hal::TimeNs now) {
  const double dt_s = pose_.taken_ns == 0 ? 0.0 : hal::to_seconds(now - pose_.taken_ns);
  pose_ = rolled(pose_, command_.left_m_s * dt_s, command_.right_m_s * dt_s, hal::thymio::kind().drive()->wheel_base_m);
  pose_.taken_ns = now;
}

}  // namespace tandem::bridges::thymio_emulator
