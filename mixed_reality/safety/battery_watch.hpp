// Stops a real robot whose battery is low.
#pragma once
#include "hal/device/body_sensors.hpp"
#include "hal/time.hpp"

namespace tandem::mixed_reality {

/// Low is what the battery of the robot's kind says, for so long: a motor that starts draws the voltage down for a
/// moment, and that is not meant.
class BatteryWatch {
 public:
  static constexpr double kFor_s = 2.0;

  explicit BatteryWatch(const hal::RobotKind& kind) {
    if (const auto* const part = kind.part<hal::BatteryPart>(); part != nullptr) limit_ = *part;
  }

  /// Once a tick; readings that are not fresh say nothing.
  bool low(const hal::Battery& battery, hal::TimeNs now) noexcept {
    const bool by_volts = limit_.low_V > 0.0 && battery.supply_V > 0.0F;
    const bool reached = by_volts ? battery.supply_V <= static_cast<float>(limit_.low_V)
                                  : battery.charge <= static_cast<float>(limit_.low_charge);
    const bool below = battery.validity == hal::Validity::Fresh && reached;
    if (!below || !begun_) well_ns_ = now;
    begun_ = true;
    return below && hal::to_seconds(now - well_ns_) >= kFor_s;
  }

 private:
  hal::BatteryPart limit_;
  bool begun_ = false;
  hal::TimeNs well_ns_ = 0;
};

}  // namespace tandem::mixed_reality
