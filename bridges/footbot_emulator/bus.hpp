// The robot's CAN bus of 1 Mbit/s: arbitration and timing.
#pragma once
#include <deque>
#include <optional>
#include <vector>

#include "bridges/footbot_emulator/message.hpp"

namespace tandem::bridges::footbot_emulator {

/// Every sender sends its frames in their order; where several want to begin at once, the lowest identifier does. So
/// the parts of messages of several senders interleave as they do on the robot.
class Bus {
 public:
  explicit Bus(std::size_t senders) : queues_(senders) {}

  /// Frames of `sender` that may go from `ready` on. Times of one sender must not decrease.
  void send(std::size_t sender, const std::vector<Frame>& frames, hal::TimeNs ready);
  /// What `sender` has not sent yet never will be.
  void clear(std::size_t sender) { queues_[sender].clear(); }
  /// A frame of the host has ended at `at`.
  void occupied_until(hal::TimeNs at) { free_at_ = std::max(free_at_, at); }

  struct Passed {
    std::size_t sender;
    TimedFrame frame;
  };
  /// The next frame that has passed by `now`.
  std::optional<Passed> next(hal::TimeNs now);
  /// When `next` will have something, if no other node speaks.
  std::optional<hal::TimeNs> next_at() const;

 private:
  struct Winner {
    std::size_t sender;
    hal::TimeNs end;
  };
  std::optional<Winner> winner() const;

  std::vector<std::deque<TimedFrame>> queues_;  // frames and when they are ready
  hal::TimeNs free_at_ = 0;
};

}  // namespace tandem::bridges::footbot_emulator
