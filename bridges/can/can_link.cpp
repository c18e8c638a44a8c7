#include "bridges/can/can_link.hpp"

namespace tandem::bridges {

void BusRecord::become(BusState state) noexcept {
  if (state == state_ || state_ == BusState::Gone) return;
  if (state == BusState::BusOff) ++counts.bus_offs;
  if (state == BusState::Gone || (state == BusState::Down && can_pass(state_))) ++counts.downs;
  if (can_pass(state) && !can_pass(state_)) ++counts.restarts;
  state_ = state;
}

}  // namespace tandem::bridges
