// Faults of the hub itself, on demand: for trying out what a set-up of robots does when its hub is late, frozen or
// dead.
#pragma once
#include <cstdint>
#include <string>
#include <vector>

#include "hal/result.hpp"
#include "hal/time.hpp"

namespace tandem::app {

enum class HubFaultKind : std::uint8_t { Stall, Freeze, Kill, Clock };

/// Times count from the start of the run.
struct HubFault {
  HubFaultKind kind = HubFaultKind::Stall;
  hal::TimeNs from = 0;
  hal::TimeNs lasts = 0;    ///< Stall, Freeze
  hal::TimeNs jump_ns = 0;  ///< Clock; negative: backwards
};

/// Reads NAME[=VALUE]@START[+DURATION], as for emulated robots: "stall@5s+0.4s", "clock=-1h@5s". A bare number is in
/// seconds. Errors name what is wrong and list the faults that there are.
hal::Result<HubFault> parse_hub_fault(const std::string& text);

/// One line a fault: how it is written and what it does.
std::string hub_fault_manual();

/// The faults of one run. Belongs to the loop's thread.
class HubFaults {
 public:
  /// Error: the first text that cannot be read.
  static hal::Result<HubFaults> make(const std::vector<std::string>& texts);

  /// Does what is due, each fault once: returns late, or never. Call it in every tick, before commands leave; the first
  /// call is the start of the run. A freeze stops the whole process, as a terminal or a debugger does; the process that
  /// wakes it up is a child that holds no descriptors.
  void apply(hal::TimeNs now);

 private:
  std::vector<HubFault> faults_;  // by time, the next one last
  hal::TimeNs start_ns_ = 0;
  bool started_ = false;
};

/// Nanoseconds since 1970 as this program believes them to be: the system's clock, and the jumps of `Clock`.
hal::TimeNs hub_unix_ns() noexcept;

}  // namespace tandem::app
