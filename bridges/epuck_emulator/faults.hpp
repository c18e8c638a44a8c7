// Faults on demand between a robot and its host, at given times and from a seed.
#pragma once
#include <array>
#include <cstdint>
#include <optional>

#include "bridges/emulation/fault_schedule.hpp"

namespace tandem::bridges::epuck_emulator {

enum class FaultKind : std::uint8_t { Silent, Deaf, Garbage, Drop, Double, Corrupt, Delay, Reset, Truncate, Hangup };

using Fault = FaultOf<FaultKind>;

extern const FaultTable<Fault> kFaults;

/// All faults of a run, and the chance in them.
class FaultPlan : public FaultSchedule<Fault> {
 public:
  using FaultSchedule::FaultSchedule;

  /// What arrives of `byte`, if anything.
  std::optional<std::uint8_t> to_robot(std::uint8_t byte, hal::TimeNs at);
  std::optional<std::uint8_t> to_host(std::uint8_t byte, hal::TimeNs at);
  /// Whether what arrived of a byte arrives twice.
  bool doubles(hal::TimeNs at) { return happens(FaultKind::Double, at); }
  /// What is added to every byte towards the host.
  hal::TimeNs delay_ns(hal::TimeNs at) const { return longest_ns(FaultKind::Delay, at); }
  /// Any other byte than `byte`.
  std::uint8_t garble(std::uint8_t byte);

 private:
  std::optional<std::uint8_t> through_the_air(std::uint8_t byte, hal::TimeNs at);
};

}  // namespace tandem::bridges::epuck_emulator
