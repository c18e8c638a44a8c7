#include "bridges/eyebot/liveness.hpp"

#include <algorithm>
#include <limits>

namespace tandem::bridges::eyebot {
namespace {

constexpr unsigned kNamesakes = 3;
constexpr hal::TimeNs kRow = 2 * hal::kNsPerSecond;
constexpr hal::TimeNs kNamesakesShown = 3 * hal::kNsPerSecond;

}  // namespace

void Liveness::begin(std::int32_t session, hal::TimeNs received_ns) noexcept {
  if (known_) {
    newest_ = (newest_ + 1) % before_.size();
    before_[newest_] = session_;
    befores_ = std::min(befores_ + 1, before_.size());
    ++restarts_;
  }
  known_ = true;
  session_ = session;
  begun_ns_ = seen_ns_ = received_ns;
  rival_ = false;
  turns_ = 0;
}

Sender Liveness::note(std::int32_t session, hal::TimeNs received_ns) noexcept {
  if (!known_) {
    begin(session, received_ns);
    return Sender::Current;
  }
  if (session == session_) {
    if (rival_ && rival_ns_ >= seen_ns_ && received_ns > rival_ns_) {
      turns_ = received_ns - turn_ns_ <= kRow ? turns_ + 1 : 1;
      turn_ns_ = received_ns;
    }
    seen_ns_ = std::max(seen_ns_, received_ns);
    return Sender::Current;
  }
  if (received_ns < seen_ns_) return Sender::Other;  // it lay in the inbox while the robot restarted
  bool replaced = false;
  for (std::size_t i = 0; i < befores_; ++i) {
    replaced = replaced || before_[(newest_ + before_.size() - i) % before_.size()] == session;
  }
  if (received_ns - seen_ns_ < (replaced ? kLostAfter : kTrial)) {
    ++others_;
    rival_ = true;
    rival_ns_ = received_ns;
    return Sender::Other;
  }
  begin(session, received_ns);
  return Sender::Restarted;
}

void Liveness::note_heartbeat(std::int32_t period_ms, hal::TimeNs received_ns) noexcept {
  beating_ = true;
  heartbeat_ns_ = received_ns;
  period_ns_ = std::clamp<hal::TimeNs>(period_ms, 20, 2000) * hal::kNsPerMs;
}

Pulse Liveness::pulse(hal::TimeNs now) const noexcept {
  if (!beating_) return Pulse::Never;
  const hal::TimeNs age = now - heartbeat_ns_;
  if (age > lost_after()) return Pulse::Lost;
  return age > stale_after() ? Pulse::Stale : Pulse::Beating;
}

hal::TimeNs Liveness::next_change(hal::TimeNs now) const noexcept {
  switch (pulse(now)) {
    case Pulse::Beating:
      return heartbeat_ns_ + stale_after() + 1;
    case Pulse::Stale:
      return heartbeat_ns_ + lost_after() + 1;
    case Pulse::Never:
    case Pulse::Lost:
      break;
  }
  return std::numeric_limits<hal::TimeNs>::max();
}

bool Liveness::namesakes(hal::TimeNs now) const noexcept {
  return turns_ >= kNamesakes && now - turn_ns_ < kNamesakesShown;
}

}  // namespace tandem::bridges::eyebot
