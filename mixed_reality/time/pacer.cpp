#include "mixed_reality/time/pacer.hpp"

#include <algorithm>

#include "hal/check.hpp"

namespace tandem::mixed_reality {

Pacer::Pacer(TimeSource& time, std::int64_t ticks_per_second) : time_(time), ticks_per_second_(ticks_per_second) {
  TANDEM_CHECK(ticks_per_second > 0, "a paced run has at least one tick a second");
}

void Pacer::start() noexcept {
  start_ns_ = time_.now_ns();
  began_ns_ = start_ns_;
  slot_ = 0;
}

hal::TimeNs Pacer::end_tick() noexcept {
  const hal::TimeNs ended_ns = time_.now_ns();
  ++ledger_.ticks;
  ledger_.step.add(ended_ns - began_ns_);
  const hal::TimeNs lateness_ns = ended_ns - deadline_ns();
  if (lateness_ns > 0) {
    ++ledger_.deadline_misses;
    ledger_.largest_lateness_ns = std::max(ledger_.largest_lateness_ns, lateness_ns);
  }
  return ended_ns;
}

bool Pacer::wait_for_next(const std::atomic<bool>& stop) noexcept {
  const hal::TimeNs ended_ns = end_tick();

  // The next slot, or the one that is running already: those between are left out.
  const std::int64_t next = std::max(slot_ + 1, slot_at(ended_ns));
  ledger_.skipped_slots += static_cast<std::uint64_t>(next - slot_ - 1);
  slot_ = next;

  const bool sleeps = ended_ns < scheduled_ns();
  if (sleeps) time_.sleep_until(scheduled_ns(), stop);
  if (stop.load(std::memory_order_relaxed)) return false;
  began_ns_ = time_.now_ns();
  if (sleeps) ledger_.wake_up.add(began_ns_ - scheduled_ns());
  return true;
}

std::int64_t Pacer::slot_at(hal::TimeNs now_ns) const noexcept {
  const hal::TimeNs since_ns = now_ns - start_ns_;
  const hal::TimeNs seconds = since_ns / hal::kNsPerSecond;
  const hal::TimeNs rest_ns = since_ns % hal::kNsPerSecond;
  std::int64_t slot = seconds * ticks_per_second_ + rest_ns * ticks_per_second_ / hal::kNsPerSecond;
  if (start_of(slot + 1) <= now_ns) ++slot;  // the start of a slot is rounded down to whole nanoseconds
  return slot;
}

}  // namespace tandem::mixed_reality
