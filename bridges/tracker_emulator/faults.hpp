// Faults on demand: what may go wrong with a tracker, at given times and from a seed.
#pragma once
#include <string>
#include <string_view>
#include <vector>

#include "bridges/emulation/fault_schedule.hpp"

namespace tandem::bridges::tracker_emulator {

enum class FaultKind : std::uint8_t { Gap, Lose, Double, Swap, Late, Mirror, Shift, Clock, Garbage };

struct Fault : FaultTimes {
  FaultKind kind = FaultKind::Gap;
  double probability = 0.0;  ///< Lose, Double, Swap, Late, Garbage
  double shift_m = 0.0;      ///< Shift
  hal::TimeNs jump_ns = 0;   ///< Clock
  std::string text{};        ///< as written

  bool is_moment() const noexcept { return false; }
};

/// Reads NAME[=VALUE][@[drive+]START[+DURATION]]. Errors name what is wrong and list the faults that there are.
hal::Result<Fault> parse_fault(std::string_view text);
/// One line a fault: how it is written and what it does.
std::string fault_manual();

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
