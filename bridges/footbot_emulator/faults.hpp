// Faults on demand: what may go wrong in a foot-bot and on its bus, at given times and from a seed.
#pragma once
#include <array>
#include <string>
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

/// Restart happens at `from`.
struct Fault : FaultTimes {
  FaultKind kind = FaultKind::Silent;
  std::optional<Place> module{};    ///< Missing, Restart, Silent, Deaf, Lie; none: all
  Lie lie = Lie::None;              ///< Lie
  double probability = 0.0;         ///< Drop, Lose, Double, Swap: of each frame
  hal::TimeNs delay_ns = 0;         ///< Delay
  std::array<double, 3> carried{};  ///< Carry: by x, y in metres, turned by radians
  std::string text{};               ///< as written

  bool is_moment() const noexcept { return kind == FaultKind::Restart || kind == FaultKind::Carry; }
};

/// Reads NAME[=VALUE][@[drive+]START[+DURATION]]: "missing=gripper@0s+3s", "drop=0.01". A bare number is in seconds.
/// Errors name what is wrong and list the faults that there are.
hal::Result<Fault> parse_fault(std::string_view text);

/// One line a fault: how it is written and what it does.
std::string fault_manual();

/// All faults of a run, and the chance in them.
class FaultPlan : public FaultSchedule<Fault> {
 public:
  using FaultSchedule::FaultSchedule;

  /// Whether a frame of the host gets onto the bus.
  bool reaches_robot(hal::TimeNs at);
  /// What a frame of a module becomes on its way to the host: nothing, itself, twice itself, or it waits for the
  /// sender's next. Frames leave in the order of their times.
  void to_host(const TimedFrame& frame, std::vector<TimedFrame>& out);

 private:
  std::array<std::optional<TimedFrame>, 256> held_back_;  // by sender
  hal::TimeNs last_out_ = 0;
};

/// Does to the robot what concerns its modules.
void apply(const FaultPlan::Change& change, Footbot& robot);

}  // namespace tandem::bridges::footbot_emulator
