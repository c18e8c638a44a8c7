// Round trips of questions and answers, counted by how long they took.
#pragma once
#include <cstdint>

#include "hal/duration_histogram.hpp"
#include "hal/time.hpp"

namespace tandem::bridges {

/// How long answers took. Allocates nothing.
struct RoundTrips {
  hal::DurationHistogram durations;
  hal::TimeNs last_ns = 0, sum_ns = 0;
  std::uint64_t changes = 0;
  hal::TimeNs sum_changes_ns = 0;  ///< of one round trip against the one before, without its sign

  void add(hal::TimeNs duration_ns) noexcept {
    const hal::TimeNs change_ns = duration_ns - last_ns;
    if (durations.count() > 0) {
      ++changes;
      sum_changes_ns += change_ns < 0 ? -change_ns : change_ns;
    }
    durations.add(duration_ns);
    last_ns = duration_ns;
    sum_ns += duration_ns;
  }
  /// Adds those of another conversation with the same robot.
  void add(const RoundTrips& other) noexcept {
    durations.add(other.durations);
    sum_ns += other.sum_ns;
    changes += other.changes;
    sum_changes_ns += other.sum_changes_ns;
  }

  hal::TimeNs largest_ns() const noexcept { return durations.largest_ns(); }
  hal::TimeNs mean_ns() const noexcept {
    return durations.count() > 0 ? sum_ns / static_cast<hal::TimeNs>(durations.count()) : 0;
  }
  /// Mean change from one to the next.
  hal::TimeNs jitter_ns() const noexcept {
    return changes > 0 ? sum_changes_ns / static_cast<hal::TimeNs>(changes) : 0;
  }
};

}  // namespace tandem::bridges
