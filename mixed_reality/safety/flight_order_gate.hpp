// Holds back a controller's order to take off once the safety table has stopped the robot.
#pragma once
#include <optional>

#include "hal/device/flight.hpp"

namespace tandem::mixed_reality {

/// A stopped robot is told to hover. If it stands on the ground when it is re-armed, the order that its controller gave
/// before the stop does not lift it again: it takes a new order to do that. In the air the order goes on.
class FlightOrderGate {
 public:
  /// Once a tick. `wanted`: the controller's; `on_ground`: motors off, or landed, as far as the robot says.
  /// @returns the robot's order.
  hal::FlightTask pass(const hal::FlightTask& wanted, bool may_drive, bool on_ground) noexcept {
    if (!may_drive) {
      stopped_at_ = wanted.order;
      return wanted.order == hal::FlightOrder::Land ? wanted : hal::FlightTask{};
    }
    if (stopped_at_ != wanted.order || !on_ground) stopped_at_.reset();
    const bool lifts = wanted.order == hal::FlightOrder::TakeOff || wanted.order == hal::FlightOrder::Attach;
    return stopped_at_ && lifts ? hal::FlightTask{} : wanted;
  }

 private:
  std::optional<hal::FlightOrder> stopped_at_;  // the order at the last stop, while it has not been let pass since
};

/// Whether a robot says that it stands. Not known: it does not.
inline bool says_on_ground(const hal::FlightState* state) noexcept {
  return state != nullptr && state->validity == hal::Validity::Fresh &&
         (state->phase == hal::FlightPhase::Off || state->phase == hal::FlightPhase::Landed);
}

}  // namespace tandem::mixed_reality
