// Faults on demand in an eye-bot and between it and its hub, at given times and from a seed.
#pragma once
#include <string>
#include <vector>

#include "bridges/emulation/fault_schedule.hpp"
#include "bridges/eyebot_emulator/eyebot.hpp"

namespace tandem::bridges::eyebot_emulator {

enum class FaultKind : std::uint8_t {
  Silent,
  Deaf,
  Drop,
  Double,
  Swap,
  Delay,
  Lose,
  Repeat,
  Overtake,
  Lag,
  Fingerprint,
  Truncate,
  Restart,
  Clock,
  Battery,
  NoPosition,
  Hardware,
  Namesake,
  Flood,
  Damage,
  Future,
  Place,
  SecondHub
};

using Fault = FaultOf<FaultKind>;

extern const FaultTable<Fault> kFaults;

/// All faults of one robot's run, and the chance in them.
class FaultPlan : public FaultSchedule<Fault> {
 public:
  using FaultSchedule::FaultSchedule;

  /// What a message becomes on its way: nothing, itself, something else, twice itself, or it waits for the next of its
  /// channel. Messages of one way leave in the order of their times.
  void to_hub(const Datagram& message, std::vector<Datagram>& out);
  void to_robot(const Datagram& message, std::vector<Datagram>& out);

 private:
  bool is_mute(FaultKind kind, const std::string& channel, hal::TimeNs at) const;
  void damage(const std::string& channel, Bytes& data, hal::TimeNs at);

  Way<Datagram, std::string> out_{FaultKind::Drop, FaultKind::Double, FaultKind::Swap, FaultKind::Delay};
  Way<Datagram, std::string> in_{FaultKind::Lose, FaultKind::Repeat, FaultKind::Overtake, FaultKind::Lag};
};

/// Does to the robot what concerns it alone. `new_session` is that of a restart.
void apply(const FaultPlan::Change& change, Eyebot& robot, std::int32_t new_session);

}  // namespace tandem::bridges::eyebot_emulator
