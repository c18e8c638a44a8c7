// Faults on demand: what may go wrong in a Thymio and on its line, at given times and from a seed.
#pragma once
#include <optional>
#include <string>
#include <vector>

#include "bridges/emulation/fault_schedule.hpp"
#include "bridges/thymio_emulator/thymio.hpp"

namespace tandem::bridges::thymio_emulator {

enum class FaultKind : std::uint8_t { Restart, Program, Silent, Deaf, Lie, Drop, Lose, Double, Delay, Hangup };

/// Restart and Program happen at `from`.
struct Fault : FaultTimes {
  FaultKind kind = FaultKind::Silent;
  Lie lie = Lie::None;       ///< Lie
  double probability = 0.0;  ///< Drop, Lose, Double: of each message
  hal::TimeNs delay_ns = 0;  ///< Delay
  std::string text{};        ///< as written

  bool is_moment() const noexcept { return kind == FaultKind::Restart || kind == FaultKind::Program; }
};

/// Reads NAME[=VALUE][@[drive+]START[+DURATION]]: "silent@5s+2s", "drop=0.01". A bare number is in seconds. Errors name
/// what is wrong and list the faults that there are.
hal::Result<Fault> parse_fault(std::string_view text);

/// One line a fault: how it is written and what it does.
std::string fault_manual();

/// All faults of a run, and the chance in them.
class FaultPlan : public FaultSchedule<Fault> {
 public:
  using FaultSchedule::FaultSchedule;

  /// Whether a message of a host gets to the robot.
  bool reaches_robot(hal::TimeNs at) { return !happens(FaultKind::Lose, at); }
  /// What a message of the robot becomes on its way: nothing, itself, twice itself; later perhaps.
  void to_host(const TimedMessage& message, std::vector<TimedMessage>& out);

 private:
  hal::TimeNs last_out_ = 0;
};

/// Does to the robot what concerns it, and not its line.
void apply(const FaultPlan::Change& change, Thymio& robot);

}  // namespace tandem::bridges::thymio_emulator
