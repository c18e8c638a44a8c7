// Faults on demand of a tracker, at given times and from a seed.
#pragma once
#include <cstdint>

#include "bridges/emulation/fault_schedule.hpp"

namespace tandem::bridges::tracker_emulator {

enum class FaultKind : std::uint8_t { Gap, Lose, Double, Swap, Late, Mirror, Shift, Clock, Garbage };

using Fault = FaultOf<FaultKind>;

extern const FaultTable<Fault> kFaults;

/// All faults of a run, and the chance in them.
class FaultPlan : public FaultSchedule<Fault> {
 public:
  using FaultSchedule::FaultSchedule;

  /// By how much it sees everything too far to the east.
  double shift_m(hal::TimeNs at) const;
  /// By how much its clock has been set.
  hal::TimeNs jump_ns(hal::TimeNs at) const;
};

}  // namespace tandem::bridges::tracker_emulator
