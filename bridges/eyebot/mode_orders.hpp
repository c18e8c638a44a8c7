// Orders that a robot acknowledges: said with the same number until it answers.
#pragma once
#include <array>
#include <cstdint>
#include <optional>
#include <string>

#include "bridges/eyebot_messages/messages.hpp"
#include "bridges/round_trips.hpp"
#include "hal/time.hpp"

namespace tandem::bridges::eyebot {

/// The actions of cmd_mode_t. The numbers are those of the wire.
enum class Action : std::int8_t {
  Nop = 0,
  Arm = 1,
  Disarm = 2,
  TakeOff = 3,
  Hover = 4,
  Land = 5,
  Attach = 6,
  Detach = 7,
  Stop = 8,  ///< motors off at once, also in the air
  ClearFailsafe = 9
};
inline constexpr std::size_t kActions = 10;
const char* action_name(Action action) noexcept;

/// Outcome of an order.
enum class Outcome : std::uint8_t {
  Never,
  Done,
  RejectedMode,
  RejectedRange,
  RejectedStale,
  RejectedSource,
  Unsupported,
  Failed,
  NoAnswer
};
const char* outcome_name(Outcome outcome) noexcept;

struct OrderStatistics {
  std::uint64_t orders = 0;  ///< each with a number of its own
  std::uint64_t said_again = 0;
  std::uint64_t accepted = 0;
  std::uint64_t refused = 0;
  std::uint64_t unanswered = 0;
  RoundTrips round_trips;  ///< of accepted and refused ones, from the first saying
};

/// At most one order is out; a new one replaces it. Not thread-safe.
class ModeOrders {
 public:
  static constexpr hal::TimeNs kSayAgain = 200 * hal::kNsPerMs;
  static constexpr unsigned kMostTimes = 10;
  static constexpr hal::TimeNs kTryAgain = hal::kNsPerSecond;

  struct Order {
    Action action = Action::Nop;
    float param = 0.0F;
    std::int32_t seq = 0;
    hal::TimeNs issued_ns = 0;
  };

  /// Has the robot do `action`, unless just that is being said, or was answered less than a second ago (refused as too
  /// late, or a fail-safe whose cause lasted: a fifth of a second).
  void want(Action action, float param, hal::TimeNs now) noexcept;
  /// Nothing is to be said any more.
  void withdraw() noexcept { out_ = false; }
  /// What is to be said now, if anything is due.
  std::optional<Order> due(hal::TimeNs now) noexcept;
  /// `session`: ours. @returns what it was an answer to, when it was the first one to the order that is out.
  std::optional<Action> take(const eyebot_messages::Ack& ack, std::int32_t session, hal::TimeNs received_ns) noexcept;
  hal::TimeNs next_deadline() const noexcept;

  /// The action that is being said; Nop: none.
  Action saying() const noexcept { return out_ ? order_.action : Action::Nop; }
  struct Last {
    Outcome outcome = Outcome::Never;
    hal::TimeNs at_ns = 0;
  };
  const Last& last(Action action) const noexcept { return last_[static_cast<std::size_t>(action)]; }
  /// Forgets how orders ended: they may be given again at once.
  void forget() noexcept { last_ = {}; }
  /// When the order that was answered last was first said.
  hal::TimeNs answered_issue_ns() const noexcept { return answered_issue_ns_; }
  /// The number of the next order, while none is out.
  void begin_with(std::int32_t seq) noexcept { seq_ = seq; }
  /// The number of the next order.
  std::int32_t next_seq() const noexcept { return seq_; }
  const OrderStatistics& statistics() const noexcept { return statistics_; }

 private:
  void end(Outcome outcome, hal::TimeNs now) noexcept;

  bool out_ = false;
  Order order_;
  unsigned times_ = 0;
  hal::TimeNs said_ns_ = 0;
  std::int32_t seq_ = 0;
  std::array<Last, kActions> last_;
  hal::TimeNs answered_issue_ns_ = 0;
  OrderStatistics statistics_;
};

}  // namespace tandem::bridges::eyebot
