// A CAN bus in memory: what one end sends all others receive.
#pragma once
#include <memory>
#include <utility>

#include "bridges/can/can_link.hpp"
#include "bridges/link/link.hpp"

namespace tandem::bridges {

/// The bus. Its ends may live on several threads and may outlive this object. Frames carry the clock's time at which
/// they were sent.
class MemoryBus {
 public:
  /// `capacity` frames can wait at each end; of more the newest are lost there and counted as overrun.
  explicit MemoryBus(Clock clock = monotonic_ns, std::size_t capacity = 1024);

  /// A new participant.
  std::unique_ptr<CanLink> attach();
  /// Switches every end to `state`; frames pass only where `can_pass(state)`.
  void set_state(BusState state) noexcept;
  /// While set, `send` finds no room at any end.
  void set_full(bool full) noexcept;

  struct Shared;

 private:
  std::shared_ptr<Shared> shared_;  // shared: neither bus nor end can know which of them goes last
};

}  // namespace tandem::bridges
