// Faults on demand in a foot-bot and on its bus, at given times and from a seed.
#pragma once
#include <array>
#include <optional>
#include <vector>

#include "bridges/emulation/fault_schedule.hpp"
#include "bridges/footbot_emulator/footbot.hpp"

namespace tandem::bridges::footbot_emulator {

enum class FaultKind : std::uint8_t {
  Missing,
  Restart,
  Silent,
  Deaf,
  Lie,
  Drop,
  Lose,
  Double,
  Swap,
  Delay,
  Hangup,
  Carry,
  Held
};

struct Fault : FaultOf<FaultKind> {
  std::optional<Place> module{};  ///< Missing, Restart, Silent, Deaf, Lie; none: all
  Lie lie = Lie::None;
  std::array<double, 3> carried{};  ///< Carry: by x, y in metres, turned by radians
};

extern const FaultTable<Fault> kFaults;

/// All faults of a run, and the chance in them.
class FaultPlan : public FaultSchedule<Fault> {
 public:
  using FaultSchedule::FaultSchedule;

  /// Whether a frame of the host gets onto the bus.
  bool reaches_robot(hal::TimeNs at) { return !happens(FaultKind::Lose, at); }
  /// What a frame of a module becomes on its way to the host: nothing, itself, twice itself, or it waits for the
  /// sender's next. Frames leave in the order of their times.
  void to_host(const TimedFrame& frame, std::vector<TimedFrame>& out);

 private:
  Way<TimedFrame, unsigned> way_{FaultKind::Drop, FaultKind::Double, FaultKind::Swap, FaultKind::Delay};
};

/// Does to the robot what concerns its modules.
void apply(const FaultPlan::Change& change, Footbot& robot);

}  // namespace tandem::bridges::footbot_emulator
