#include "hal/robot/shell.hpp"

#include "hal/robot/epuck.hpp"
#include "hal/robot/eyebot.hpp"
#include "hal/robot/footbot.hpp"
#include "hal/robot/thymio.hpp"

namespace tandem::hal {

void ShellPart::appear(const RobotKind& kind, Appearance& look) const {
  constexpr std::array kLooks = {&epuck::shell, &eyebot::shell, &footbot::shell, &thymio::shell};
  for (std::size_t i = 0; i < kForms.size(); ++i) {
    if (kForms[i] == of) kLooks[i]().appear(kind, look);
  }
}

}  // namespace tandem::hal
