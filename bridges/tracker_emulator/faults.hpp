// Faults on demand: what may go wrong with a tracker, at given times and from a seed.
#pragma once
#include <string>
#include <string_view>
#include <vector>

#include "bridges/emulation/fault_spec.hpp"

namespace tandem::bridges::tracker_emulator {

enum class FaultKind : std::uint8_t { Gap, Lose, Double, Swap, Late, Mirror, Shift, Clock, Garbage };

/// Active in [from, until), counted from the start of the emulator.
struct Fault {
  FaultKind kind = FaultKind::Gap;
  hal::TimeNs from = 0;
  hal::TimeNs until = kEndless;
  double probability = 0.0;  ///< Lose, Double, Swap, Late, Garbage
  double shift_m = 0.0;      ///< Shift
  hal::TimeNs jump_ns = 0;   ///< Clock
  std::string text{};        ///< as written

  bool active(hal::TimeNs since_start) const noexcept { return from <= since_start && since_start < until; }
};

/// Reads NAME[=VALUE][@START[+DURATION]]. Errors name what is wrong and list the faults that there are.
hal::Result<Fault> parse_fault(std::string_view text);
/// One line a fault: how it is written and what it does.
std::string fault_manual();

}  // namespace tandem::bridges::tracker_emulator
