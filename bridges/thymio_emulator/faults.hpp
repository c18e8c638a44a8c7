// Faults on demand in a Thymio and on its line, at given times and from a seed.
#pragma once
#include <vector>

#include "bridges/emulation/fault_schedule.hpp"
#include "bridges/thymio_emulator/thymio.hpp"

namespace tandem::bridges::thymio_emulator {

enum class FaultKind : std::uint8_t { Restart, Program, Silent, Deaf, Lie, Drop, Lose, Double, Delay, Hangup };

struct Fault : FaultOf<FaultKind> {
  Lie lie = Lie::None;
};

extern const FaultTable<Fault> kFaults;

/// All faults of a run, and the chance in them.
class FaultPlan : public FaultSchedule<Fault> {
 public:
  using FaultSchedule::FaultSchedule;

  /// Whether a message of a host gets to the robot.
  bool reaches_robot(hal::TimeNs at) { return !happens(FaultKind::Lose, at); }
  /// What a message of the robot becomes on its way: nothing, itself, twice itself; later perhaps.
  void to_host(const TimedMessage& message, std::vector<TimedMessage>& out) { pass(way_, message, 0, false, out); }

 private:
  Way<TimedMessage, int> way_{FaultKind::Drop, FaultKind::Double, {}, FaultKind::Delay};
};

/// Does to the robot what concerns it, and not its line.
void apply(const FaultPlan::Change& change, Thymio& robot);

}  // namespace tandem::bridges::thymio_emulator
