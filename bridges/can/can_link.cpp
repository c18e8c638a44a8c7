#include "bridges/can/can_link.hpp"

namespace tandem::bridges {

const char* bus_state_name(BusState state) noexcept {
  switch (state) {
    case BusState::Active:
      return "active";
    case BusState::Warning:
      return "warning";
    case BusState::Passive:
      return "passive";
    case BusState::BusOff:
      return "bus off";
    case BusState::Down:
      return "down";
    case BusState::Gone:
      return "gone";
  }
  return "";
}

void BusRecord::become(BusState state) noexcept {
  if (state == state_ || state_ == BusState::Gone) return;
  if (state == BusState::BusOff) ++counts.bus_offs;
  if (state == BusState::Gone || (state == BusState::Down && can_pass(state_))) ++counts.downs;
  if (can_pass(state) && !can_pass(state_)) ++counts.restarts;
  state_ = state;
}

}  // namespace tandem::bridges
