#include "bridges/eyebot_emulator/battery.hpp"

#include <algorithm>

namespace tandem::bridges::eyebot_emulator {

void EmulatedBattery::run(hal::TimeNs duration_ns, bool motors) noexcept {
  set(charge_ - hal::to_seconds(duration_ns) / lasts_s(motors));
}

void EmulatedBattery::set(double charge) noexcept {
  charge_ = std::clamp(charge, 0.0, 1.0);
}

}  // namespace tandem::bridges::eyebot_emulator
