#include "core/run/roll_call.hpp"

#include "mixed_reality/session/mixed_session.hpp"

namespace tandem::mixed_reality {

using core::Presence;
using core::RollRow;

std::vector<RollRow> MixedSession::roll_call() const {
  std::vector<RollRow> rows;
  for (std::size_t i = 0; i < twins_.size(); ++i) {
    const Twin& twin = *twins_[i];
    const LinkHealth health = twin.real().health();
    const bool reached = health == LinkHealth::Active, rests = rests_[i].rests();
    const bool drives =
        reached && last_[i].driving && !twin.real_robot().awaits_arming() && phase_ != RunPhase::Stopping;
    RollRow row{twin.id(), Presence::Stands, {}};
    row.presence = !reached && !rests                                                      ? Presence::MayMove
                   : twin.real_robot().awaits_arming() || twin.real_robot().awaits_rearm() ? Presence::WaitsForPerson
                   : !reached                                                              ? Presence::Unreachable
                   : drives                                                                ? Presence::Drives
                   : !rests                                                                ? Presence::Stops
                                                                                           : Presence::Stands;
    if (row.presence != Presence::Drives) row.why = phase_ == RunPhase::Stopping ? "" : last_[i].state;
    if (const std::string trouble = twin.real().trouble(); !reached && !trouble.empty())
      row.why += (row.why.empty() ? "" : ": ") + trouble;
    rows.push_back(std::move(row));
  }
  return rows;
}

/// After every latch.
void MixedSession::note_rest() {
  rests_.resize(twins_.size());
  for (std::size_t i = 0; i < twins_.size(); ++i) {
    const Twin& twin = *twins_[i];
    const bool flies = world_->space().kind(twin.robot()).flies();
    const hal::WheelSpeeds& sent = twin.sent();
    const bool moves = flies ? twin.verdict().may_drive : sent.left_m_s != 0.0 || sent.right_m_s != 0.0;
    rests_[i].note(now_.monotonic_ns, twin.real().health() == LinkHealth::Active, moves && phase_ != RunPhase::Stopping,
                   twin.real().at_rest(), twin.encoders());
  }
  if (options_.on_roll) options_.on_roll(*this);
}

}  // namespace tandem::mixed_reality
