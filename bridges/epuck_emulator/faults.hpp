// Faults on demand: what may go wrong between a robot and its host, at given times and from a seed.
#pragma once
#include <array>
#include <cstdint>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include "bridges/emulation/fault_spec.hpp"

namespace tandem::bridges::epuck_emulator {

enum class FaultKind : std::uint8_t { Silent, Deaf, Garbage, Drop, Double, Corrupt, Delay, Reset, Truncate, Hangup };

/// Active in [from, until), counted from the start of the emulator. Reset and Truncate happen at `from`.
struct Fault {
  FaultKind kind = FaultKind::Silent;
  hal::TimeNs from = 0;
  hal::TimeNs until = kEndless;
  double probability = 0.0;  ///< Drop, Double, Corrupt: of each byte, in both directions
  hal::TimeNs delay_ns = 0;  ///< Delay: added to every byte towards the host
  std::string text;          ///< as written
};

/// Reads NAME[=VALUE][@START[+DURATION]]: "silent@5s+2s", "reset@3s", "drop=0.01", "delay=20ms". A bare number is in
/// seconds. Errors name what is wrong and list the faults that there are.
hal::Result<Fault> parse_fault(std::string_view text);

/// One line a fault: how it is written and what it does.
std::string fault_manual();

/// All faults of a run, and the chance in them.
class FaultPlan {
 public:
  FaultPlan(std::vector<Fault> faults, std::uint64_t seed) : faults_(std::move(faults)), chance_(seed) {}

  /// Times from here on are on the clock of `start`.
  void begin(hal::TimeNs start);

  bool active(FaultKind kind, hal::TimeNs at) const;
  /// What arrives of `byte`, if anything.
  std::optional<std::uint8_t> to_robot(std::uint8_t byte, hal::TimeNs at);
  std::optional<std::uint8_t> to_host(std::uint8_t byte, hal::TimeNs at);
  /// Whether what arrived of a byte arrives twice.
  bool doubles(hal::TimeNs at);
  /// The longest of the delays at work.
  hal::TimeNs delay_ns(hal::TimeNs at) const;
  /// Any other byte than `byte`.
  std::uint8_t garble(std::uint8_t byte);

  struct Change {
    hal::TimeNs at = 0;
    bool begins = true;
    const Fault* fault = nullptr;
  };
  /// The next fault to begin or end by `now`, in order of time; each is told once.
  std::optional<Change> next_change(hal::TimeNs now);
  /// When `next_change` will have something.
  std::optional<hal::TimeNs> next_change_at() const;

 private:
  std::optional<std::uint8_t> through_the_air(std::uint8_t byte, hal::TimeNs at);

  std::vector<Fault> faults_;
  std::vector<Change> changes_;  // in order of time
  std::size_t told_ = 0;
  Chance chance_;
};

}  // namespace tandem::bridges::epuck_emulator
