#include "bridges/eyebot/mode_orders.hpp"

#include <limits>

namespace tandem::bridges::eyebot {
namespace {

Outcome outcome_of(std::int8_t result) noexcept {
  using eyebot_messages::Ack;
  switch (result) {
    case Ack::OK:
      return Outcome::Done;
    case Ack::REJECTED_MODE:
      return Outcome::RejectedMode;
    case Ack::REJECTED_RANGE:
      return Outcome::RejectedRange;
    case Ack::REJECTED_STALE:
      return Outcome::RejectedStale;
    case Ack::REJECTED_SOURCE:
      return Outcome::RejectedSource;
    case Ack::UNSUPPORTED:
      return Outcome::Unsupported;
    default:
      return Outcome::Failed;
  }
}

}  // namespace

const char* action_name(Action action) noexcept {
  static constexpr std::array<const char*, kActions> kNames = {
      "nothing", "arm", "disarm", "take off", "hover", "land", "attach", "detach", "stop", "clear the fail-safe"};
  return kNames[static_cast<std::size_t>(action)];
}

const char* outcome_name(Outcome outcome) noexcept {
  static constexpr std::array<const char*, 9> kNames = {"not asked for",
                                                        "done",
                                                        "refused in this mode",
                                                        "refused: out of range",
                                                        "refused: it came too late, are the clocks set alike?",
                                                        "refused: another hub controls the robot",
                                                        "not known to the robot",
                                                        "failed",
                                                        "not answered"};
  return kNames[static_cast<std::size_t>(outcome)];
}

void ModeOrders::want(Action action, float param, hal::TimeNs now) noexcept {
  if (out_ && order_.action == action) return;
  const Last& before = last(action);
  // One that was refused for its stamp gets another one; a fail-safe is cleared as soon as its cause is gone.
  const bool soon = before.outcome == Outcome::RejectedStale ||
                    (action == Action::ClearFailsafe && before.outcome == Outcome::Failed);
  const hal::TimeNs pause = soon ? kSayAgain : kTryAgain;
  if (before.outcome != Outcome::Never && now - before.at_ns < pause) return;
  out_ = true;
  order_ = {action, param, seq_, now};
  seq_ = static_cast<std::int32_t>(static_cast<std::uint32_t>(seq_) + 1U);
  times_ = 0;
  ++statistics_.orders;
}

std::optional<ModeOrders::Order> ModeOrders::due(hal::TimeNs now) noexcept {
  if (!out_ || (times_ > 0 && now - said_ns_ < kSayAgain)) return {};
  if (times_ == kMostTimes) {
    ++statistics_.unanswered;
    end(Outcome::NoAnswer, now);
    return {};
  }
  if (times_ > 0) ++statistics_.said_again;
  ++times_;
  said_ns_ = now;
  return order_;
}

std::optional<Action> ModeOrders::take(const eyebot_messages::Ack& ack, std::int32_t session,
                                       hal::TimeNs received_ns) noexcept {
  if (!out_ || times_ == 0 || ack.cmd_session != session || ack.cmd_seq != order_.seq) return {};
  const Outcome outcome = outcome_of(ack.result);
  ++(outcome == Outcome::Done ? statistics_.accepted : statistics_.refused);
  statistics_.round_trips.add(received_ns - order_.issued_ns);
  answered_issue_ns_ = order_.issued_ns;
  end(outcome, received_ns);
  return order_.action;
}

void ModeOrders::end(Outcome outcome, hal::TimeNs now) noexcept {
  out_ = false;
  last_[static_cast<std::size_t>(order_.action)] = {outcome, now};
}

hal::TimeNs ModeOrders::next_deadline() const noexcept {
  if (!out_) return std::numeric_limits<hal::TimeNs>::max();
  return times_ == 0 ? order_.issued_ns : said_ns_ + kSayAgain;
}

}  // namespace tandem::bridges::eyebot
