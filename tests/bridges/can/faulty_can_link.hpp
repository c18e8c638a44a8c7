// A CAN link that misbehaves on purpose: loses, doubles, reorders and delays frames, and goes bus-off, the same way
// each time for the same seed.
#pragma once
#include <memory>

#include "bridges/can/can_link.hpp"
#include "bridges/link/link.hpp"

namespace tandem::bridges {

/// Faults to inject. Chances are per frame and direction. What happens to frame n of a direction is a function of
/// (seed, direction, n) alone; whether the bus is off at time t, of (seed, t): no generator, no order of calls, no
/// clock matters.
struct CanFaults {
  std::uint64_t seed = 1;
  double loss = 0.0;        ///< chance that a frame vanishes
  double doubling = 0.0;    ///< chance that it comes twice
  double reordering = 0.0;  ///< chance that it comes behind the next frame of its direction, if one follows soon
  double lateness = 0.0;    ///< chance that it comes late, and all behind it as well
  hal::TimeNs late_ns = 0;  ///< how much later
  double bus_off = 0.0;     ///< time is divided into slots; chance that the bus is off during a slot
  hal::TimeNs bus_off_slot_ns = hal::kNsPerSecond;
};

/// Wraps a link. Faults hit both directions. While the bus is off, `send` refuses and what arrives is dropped.
class FaultyCanLink final : public CanLink {
 public:
  FaultyCanLink(std::unique_ptr<CanLink> inner, const CanFaults& faults, Clock clock = monotonic_ns);
  ~FaultyCanLink() override;

  /// Delayed frames leave when a later call to any function finds them due.
  Sent send(const CanFrame& frame) noexcept override;
  bool receive(CanFrame& frame) noexcept override;
  bool wait(hal::TimeNs timeout_ns) noexcept override;
  BusState state() const noexcept override;
  /// Of the side that faces the user: what was lost on the way counts as sent.
  CanStatistics statistics() const noexcept override { return record_.counts; }
  std::string name() const override { return "faulty " + inner_->name(); }

 private:
  class Way;

  bool off_at(hal::TimeNs now) const noexcept;
  void move(hal::TimeNs now) noexcept;

  std::unique_ptr<CanLink> inner_;
  CanFaults faults_;
  Clock clock_;
  hal::TimeNs start_ns_;
  std::unique_ptr<Way> out_;  // to the bus
  std::unique_ptr<Way> in_;   // from it
  BusRecord record_;
};

}  // namespace tandem::bridges
