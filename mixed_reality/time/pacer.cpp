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
  if (scheduling_ != nullptr) use_ = scheduling_->thread_use();
}

hal::TimeNs Pacer::end_tick() noexcept {
  const hal::TimeNs ended_ns = time_.now_ns();
  ++ledger_.ticks;
  ledger_.step.add(ended_ns - began_ns_);
  const hal::TimeNs lateness_ns = ended_ns - deadline_ns();
  SchedulingLog::ThreadUse used;
  if (scheduling_ != nullptr) {
    const SchedulingLog::ThreadUse now = scheduling_->thread_use();
    used = {now.ran_ns - use_.ran_ns, now.waited_ns - use_.waited_ns};
    use_ = now;
  }
  if (lateness_ns > 0) {
    ledger_.largest_lateness_ns = std::max(ledger_.largest_lateness_ns, lateness_ns);
    note_miss(ended_ns, used);
    ++ledger_.deadline_misses;
  } else {
    handed_on_ns_ = 0;
  }
  return ended_ns;
}

void Pacer::note_miss(hal::TimeNs ended_ns, const SchedulingLog::ThreadUse& used) noexcept {
  MissedDeadline miss;
  miss.tick = ledger_.ticks - 1;
  miss.lateness_ns = ended_ns - deadline_ns();
  miss.ran_ns = used.ran_ns;
  miss.waited_ns = used.waited_ns;
  miss.woke_late_ns = woke_late_ns_;
  if (scheduling_ != nullptr) {
    miss.stalled_ns = scheduling_->stalled_ns(scheduled_ns(), ended_ns);
    const hal::TimeNs kept_ns = std::max({miss.waited_ns, miss.stalled_ns, miss.woke_late_ns});
    miss.by_machine = miss.lateness_ns <= kept_ns + handed_on_ns_;
  }
  handed_on_ns_ = miss.by_machine ? miss.lateness_ns : 0;
  ledger_.misses_by_machine += miss.by_machine ? 1 : 0;
  if (ledger_.deadline_misses < PaceLedger::kKept)
    ledger_.first_misses[static_cast<std::size_t>(ledger_.deadline_misses)] = miss;
}

bool Pacer::wait_for_next(const std::atomic<bool>& stop, const Lookout& lookout) noexcept {
  const hal::TimeNs ended_ns = end_tick();

  // The next slot, or the one that is running already: those between are left out.
  const std::int64_t next = std::max(slot_ + 1, slot_at(ended_ns));
  ledger_.skipped_slots += static_cast<std::uint64_t>(next - slot_ - 1);
  slot_ = next;
  handed_on_ns_ = std::min(handed_on_ns_, std::max<hal::TimeNs>(0, ended_ns - scheduled_ns()));

  const bool sleeps = ended_ns < scheduled_ns();
  if (lookout.look) {
    lookout.look();
    for (hal::TimeNs now_ns = time_.now_ns(); sleeps && now_ns + lookout.every_ns < scheduled_ns();
         now_ns = time_.now_ns()) {
      if (stop.load(std::memory_order_relaxed)) return false;
      time_.sleep_until(now_ns + lookout.every_ns, stop);
      lookout.look();
    }
  }
  if (sleeps) time_.sleep_until(scheduled_ns(), stop);
  if (stop.load(std::memory_order_relaxed)) return false;
  began_ns_ = time_.now_ns();
  woke_late_ns_ = sleeps ? began_ns_ - scheduled_ns() : 0;
  if (sleeps) ledger_.wake_up.add(woke_late_ns_);
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
