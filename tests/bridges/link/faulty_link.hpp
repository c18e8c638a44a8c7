// A link that misbehaves on purpose: loses, delays, corrupts and breaks, the same way each time for the same seed.
#pragma once
#include <memory>

#include "bridges/link/link.hpp"

namespace tandem::bridges {

/// What goes wrong. Chances are per byte and direction. Whether byte n of a direction is hit is a function of (seed,
/// direction, n) alone; whether the link is cut at time t, of (seed, t): no generator, no order of calls, no clock
/// matters.
struct Faults {
  std::uint64_t seed = 1;
  double loss = 0.0;          ///< chance that a byte vanishes
  double corruption = 0.0;    ///< chance that one bit of a byte flips
  hal::TimeNs delay_ns = 0;   ///< added to every byte, each way
  hal::TimeNs jitter_ns = 0;  ///< and up to this much more; bytes never overtake one another
  double cut = 0.0;           ///< time is divided into slots; chance that the link is cut during a slot
  hal::TimeNs cut_slot_ns = hal::kNsPerSecond;
};

/// Wraps a link. Faults hit both directions. While cut it is HungUp: writes are refused, and what arrives is dropped;
/// then it is Open again. Time is counted from its making, on `clock`.
class FaultyLink final : public ByteLink {
 public:
  FaultyLink(std::unique_ptr<ByteLink> inner, const Faults& faults, Clock clock = monotonic_ns);
  ~FaultyLink() override;

  /// Delayed bytes leave when a later call to any function finds them due.
  std::size_t write(std::span<const std::uint8_t> bytes, hal::TimeNs budget_ns) noexcept override;
  Received read(std::span<std::uint8_t> buffer) noexcept override;
  bool wait(hal::TimeNs timeout_ns) noexcept override;
  LinkState state() const noexcept override;
  /// Of the side that faces the user: what was lost on the way counts as taken.
  LinkStatistics statistics() const noexcept override;
  std::string name() const override { return "faulty " + inner_->name(); }

 private:
  struct Queues;

  bool cut_at(hal::TimeNs now) const noexcept;
  void send_due(hal::TimeNs now) noexcept;
  void collect(hal::TimeNs now) noexcept;

  std::unique_ptr<ByteLink> inner_;
  Faults faults_;
  Clock clock_;
  hal::TimeNs start_ns_;
  std::unique_ptr<Queues> queues_;
};

}  // namespace tandem::bridges
