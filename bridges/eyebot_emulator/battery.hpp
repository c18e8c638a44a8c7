// The battery of an eye-bot without another body's: it runs down, faster in flight.
#pragma once
#include <algorithm>

#include "hal/time.hpp"

namespace tandem::bridges::eyebot_emulator {

/// Charge falls in proportion to time, at one of two rates.
class EmulatedBattery {
 public:
  static constexpr double kLow = 0.2;       ///< [chosen] reported as low
  static constexpr double kCritical = 0.1;  ///< [chosen] the robot lands

  /// A full charge lasts `flight_s` in the air, twenty times that with the motors off.
  explicit EmulatedBattery(double flight_s) : flight_s_(flight_s) {}

  void run(hal::TimeNs duration_ns, bool motors) noexcept {
    set(charge_ - hal::to_seconds(duration_ns) / lasts_s(motors));
  }
  void set(double charge) noexcept { charge_ = std::clamp(charge, 0.0, 1.0); }
  double charge() const noexcept { return charge_; }
  /// Until it is empty, as it is used now.
  double time_left_s(bool motors) const noexcept { return charge_ * lasts_s(motors); }

 private:
  double lasts_s(bool motors) const noexcept { return motors ? flight_s_ : 20.0 * flight_s_; }

  double flight_s_;
  double charge_ = 1.0;
};

}  // namespace tandem::bridges::eyebot_emulator
