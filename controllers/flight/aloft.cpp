#include "controllers/flight/aloft.hpp"

#include <cmath>

#include "hal/elementary.hpp"

namespace tandem::controllers {
namespace {

constexpr hal::TimeNs kOldest_ns = 500'000'000;

}  // namespace

using hal::FlightFailsafe;
using hal::FlightOrder;
using hal::FlightPhase;

Aloft::Aloft(hal::Robot& robot)
    : task_(robot.actuator<hal::FlightTask>()),
      state_(robot.sensor<hal::FlightState>()),
      place_(robot.sensor<hal::Positioning>()),
      clock_(robot.sensor<hal::Clock>()) {}

bool Aloft::knows(const hal::Reading& reading) const noexcept {
  return reading.validity == hal::Validity::Fresh && clock_.now_ns - reading.taken_ns <= kOldest_ns;
}

bool Aloft::ready() noexcept {
  task_.speed_m_s = 0.0;
  if (landing_) {
    task_.order = FlightOrder::Land;
    return false;
  }
  if (!knows(state_)) {
    // On its way up it goes on: what it does once it is there is to hover.
    if (task_.order != FlightOrder::TakeOff) task_.order = FlightOrder::Fly;
    return false;
  }
  switch (state_.phase) {
    case FlightPhase::Landed:
      // Who has just come down without being told to stays there: its fail-safe says why.
      task_.order = state_.failsafe == FlightFailsafe::None ? FlightOrder::TakeOff : FlightOrder::Fly;
      return false;
    case FlightPhase::TakingOff:
      task_.order = FlightOrder::TakeOff;
      return false;
    case FlightPhase::Attached:
    case FlightPhase::Detaching:
      task_.order = FlightOrder::Detach;
      return false;
    case FlightPhase::Hovering:
    case FlightPhase::Flying:
      break;
    default:  // without power, stopped, or on the way down or up by another's order
      return false;
  }
  task_.order = FlightOrder::Fly;
  // A command that came too late ends its own fail-safe with the next one.
  const bool free = state_.failsafe == FlightFailsafe::None || state_.failsafe == FlightFailsafe::CommandTimeout;
  return free && knows(place_);
}

bool Aloft::down() const noexcept {
  return landing_ && knows(state_) && (state_.phase == FlightPhase::Landed || state_.phase == FlightPhase::Off);
}

double Aloft::heading_rad() const noexcept {
  const auto& q = place_.q_WB;
  return hal::atan2(2.0 * (q[0] * q[3] + q[1] * q[2]), 1.0 - 2.0 * (q[2] * q[2] + q[3] * q[3]));
}

}  // namespace tandem::controllers
