// Faults on demand: what may go wrong in a Thymio and on its line, at given times and from a seed.
#pragma once
#include <optional>
#include <string>
#include <vector>

#include "bridges/emulation/fault_spec.hpp"
#include "bridges/thymio_emulator/thymio.hpp"

namespace tandem::bridges::thymio_emulator {

enum class FaultKind : std::uint8_t { Restart, Program, Silent, Deaf, Lie, Drop, Lose, Double, Delay, Hangup };

/// Active in [from, until), counted from the start of the emulator. Restart and Program happen at `from`.
struct Fault {
  FaultKind kind = FaultKind::Silent;
  hal::TimeNs from = 0;
  hal::TimeNs until = kEndless;
  Lie lie = Lie::None;       ///< Lie
  double probability = 0.0;  ///< Drop, Lose, Double: of each message
  hal::TimeNs delay_ns = 0;  ///< Delay
  std::string text{};        ///< as written
};

/// Reads NAME[=VALUE][@START[+DURATION]]: "silent@5s+2s", "drop=0.01". A bare number is in seconds. Errors name what is
/// wrong and list the faults that there are.
hal::Result<Fault> parse_fault(std::string_view text);

/// One line a fault: how it is written and what it does.
std::string fault_manual();

/// All faults of a run, and the chance in them.
class FaultPlan {
 public:
  FaultPlan(std::vector<Fault> faults, std::uint64_t seed) : faults_(std::move(faults)), chance_(seed) {}

  /// Times from here on are on the clock of `start`.
  void begin(hal::TimeNs start);

  struct Change {
    hal::TimeNs at = 0;
    bool begins = true;
    const Fault* fault = nullptr;
  };
  /// The next fault to begin or end by `now`, in order of time; each is told once.
  std::optional<Change> next_change(hal::TimeNs now);
  /// When `next_change` will have something.
  std::optional<hal::TimeNs> next_change_at() const;

  /// Whether a message of a host gets to the robot.
  bool reaches_robot(hal::TimeNs at) { return !happens(FaultKind::Lose, at); }
  /// What a message of the robot becomes on its way: nothing, itself, twice itself; later perhaps.
  void to_host(const TimedMessage& message, std::vector<TimedMessage>& out);

 private:
  bool happens(FaultKind kind, hal::TimeNs at);

  std::vector<Fault> faults_;
  std::vector<Change> changes_;  // in order of time
  std::size_t told_ = 0;
  Chance chance_;
  hal::TimeNs last_out_ = 0;
};

/// Does to the robot what concerns it, and not its line.
void apply(const FaultPlan::Change& change, Thymio& robot);

}  // namespace tandem::bridges::thymio_emulator
