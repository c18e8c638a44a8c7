// Mailbox between the receiving thread and the one that uses the messages: the newest of each topic wins.
//
// Readings are states: the next one replaces them, so a user that is slow, or a sender that floods, leaves nothing
// behind but the newest. Acknowledgements and heartbeats are kept in a row of some, of which the oldest are dropped.
#pragma once
#include <array>
#include <condition_variable>
#include <cstddef>
#include <mutex>
#include <span>
#include <vector>

#include "bridges/eyebot/neighbours.hpp"
#include "bridges/eyebot/topic.hpp"

namespace tandem::bridges::eyebot {

/// A message as it came.
struct Letter {
  std::vector<std::byte> data;
  hal::TimeNs received_ns = 0;  ///< CLOCK_MONOTONIC
};

struct TopicStatistics {
  std::uint64_t received = 0;
  std::uint64_t lost = 0;      ///< by gaps in the sequence
  std::uint64_t old = 0;       ///< not newer than the one before: doubled or overtaken on the way; refused
  std::uint64_t replaced = 0;  ///< by a newer one before anybody took it
  std::uint64_t refused = 0;   ///< of another type, without a header, or too large
};

/// Thread-safe. Allocates when letters become larger than ever before, else never.
class Inbox {
 public:
  Inbox();

  /// Refuses what is not newer than the last of the same sender (a sender that restarted has another session). Of
  /// twenty refused for that in a row the last is taken: then it was the numbering that was wrong.
  void deliver(Topic topic, std::span<const std::byte> data, hal::TimeNs received_ns) noexcept;
  /// The oldest that waits; swapped into `letter`. False when none does.
  bool take(Topic topic, Letter& letter) noexcept;
  /// Waits for a delivery, or `wake`, since the last wait; at most `timeout_ns`.
  void wait(hal::TimeNs timeout_ns);
  void wake();

  /// Other speakers that are heard; thread-safe as well.
  Neighbours& neighbours() noexcept { return neighbours_; }

  TopicStatistics statistics(Topic topic) const;
  TopicStatistics statistics() const;  ///< of all topics together

 private:
  static constexpr std::size_t kRow = 16;
  struct Slot {
    std::size_t depth = 1;
    std::array<Letter, kRow> letters;  // a ring
    std::size_t first = 0, count = 0;
    bool known = false;  // something came
    std::int32_t session = 0, seq = 0;
    unsigned old_in_row = 0;
    TopicStatistics statistics;
  };
  static bool in_order(Slot& slot, std::int32_t session, std::int32_t seq) noexcept;
  static void put(Slot& slot, std::span<const std::byte> data, hal::TimeNs received_ns) noexcept;

  mutable std::mutex mutex_;
  std::condition_variable changed_;
  bool news_ = false;
  std::array<Slot, kTopics> slots_;
  Neighbours neighbours_;
};

}  // namespace tandem::bridges::eyebot
