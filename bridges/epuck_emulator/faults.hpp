// Faults on demand: what may go wrong between a robot and its host, at given times and from a seed.
#pragma once
#include <array>
#include <cstdint>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include "bridges/emulation/fault_schedule.hpp"

namespace tandem::bridges::epuck_emulator {

enum class FaultKind : std::uint8_t { Silent, Deaf, Garbage, Drop, Double, Corrupt, Delay, Reset, Truncate, Hangup };

/// Reset and Truncate happen at `from`.
struct Fault : FaultTimes {
  FaultKind kind = FaultKind::Silent;
  double probability = 0.0;  ///< Drop, Double, Corrupt: of each byte, in both directions
  hal::TimeNs delay_ns = 0;  ///< Delay: added to every byte towards the host
  std::string text;          ///< as written

  bool is_moment() const noexcept { return kind == FaultKind::Reset || kind == FaultKind::Truncate; }
};

/// Reads NAME[=VALUE][@[drive+]START[+DURATION]]: "silent@5s+2s", "reset@3s", "drop=0.01", "delay=20ms". A bare number
/// is in seconds. Errors name what is wrong and list the faults that there are.
hal::Result<Fault> parse_fault(std::string_view text);

/// One line a fault: how it is written and what it does.
std::string fault_manual();

/// All faults of a run, and the chance in them.
class FaultPlan : public FaultSchedule<Fault> {
 public:
  using FaultSchedule::FaultSchedule;

  /// What arrives of `byte`, if anything.
  std::optional<std::uint8_t> to_robot(std::uint8_t byte, hal::TimeNs at);
  std::optional<std::uint8_t> to_host(std::uint8_t byte, hal::TimeNs at);
  /// Whether what arrived of a byte arrives twice.
  bool doubles(hal::TimeNs at) { return happens(FaultKind::Double, at); }
  /// Any other byte than `byte`.
  std::uint8_t garble(std::uint8_t byte);

 private:
  std::optional<std::uint8_t> through_the_air(std::uint8_t byte, hal::TimeNs at);
};

}  // namespace tandem::bridges::epuck_emulator
