// When a real robot's battery is so low that the robot is to be stopped.
#pragma once
#include "hal/device/body_sensors.hpp"
#include "hal/time.hpp"

namespace tandem::mixed_reality {

/// Below this part of the full charge, for so long, a battery is low: a motor that starts draws the voltage down for a
/// moment, and that is not meant.
struct BatteryLimit {
  double charge = 0.05;
  double for_s = 2.0;
};

class BatteryWatch {
 public:
  explicit BatteryWatch(const BatteryLimit& limit = {}) noexcept : limit_(limit) {}

  /// Once a tick; readings that are not fresh say nothing.
  bool low(const hal::Battery& battery, hal::TimeNs now) noexcept {
    const bool below = battery.validity == hal::Validity::Fresh && static_cast<double>(battery.charge) < limit_.charge;
    if (!below) well_ns_ = now;
    return below && hal::to_seconds(now - well_ns_) >= limit_.for_s;
  }

 private:
  BatteryLimit limit_;
  hal::TimeNs well_ns_ = 0;
};

}  // namespace tandem::mixed_reality
