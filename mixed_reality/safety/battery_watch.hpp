// When a real robot's battery is so low that the robot is to be stopped.
#pragma once
#include "bridges/bridge_type.hpp"
#include "hal/device/body_sensors.hpp"
#include "hal/time.hpp"

namespace tandem::mixed_reality {

using bridges::BatteryLimit;

class BatteryWatch {
 public:
  explicit BatteryWatch(const BatteryLimit& limit = {}) noexcept : limit_(limit) {}

  /// Once a tick; readings that are not fresh say nothing.
  bool low(const hal::Battery& battery, hal::TimeNs now) noexcept {
    const bool by_volts = limit_.supply_V > 0.0 && battery.supply_V > 0.0F;
    const bool reached = by_volts ? battery.supply_V <= static_cast<float>(limit_.supply_V)
                                  : battery.charge <= static_cast<float>(limit_.charge);
    const bool below = battery.validity == hal::Validity::Fresh && reached;
    if (!below || !begun_) well_ns_ = now;
    begun_ = true;
    return below && hal::to_seconds(now - well_ns_) >= limit_.for_s;
  }

 private:
  BatteryLimit limit_;
  bool begun_ = false;
  hal::TimeNs well_ns_ = 0;
};

}  // namespace tandem::mixed_reality
