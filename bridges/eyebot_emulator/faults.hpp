// Faults on demand: what may go wrong in an eye-bot and between it and its hub, at given times and from a seed.
#pragma once
#include <map>
#include <optional>
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

/// Restart, Clock and Battery happen at `from`.
struct Fault : FaultTimes {
  FaultKind kind = FaultKind::Silent;
  std::string channel{};  ///< Silent, Deaf, Damage: the end of the channel's name; empty: all
  double probability =
      0.0;  ///< Drop, Double, Swap, Lose, Repeat, Overtake, Fingerprint, Truncate, Future: of each message
  hal::TimeNs time_ns = 0;  ///< Delay, Lag, Clock
  double charge = 0.0;      ///< Battery: 0 to 1
  int rate_Hz = 0;          ///< Flood
  double length_m = 0.0;    ///< Place
  std::string text{};       ///< as written

  bool is_moment() const noexcept {
    return kind == FaultKind::Restart || kind == FaultKind::Clock || kind == FaultKind::Battery;
  }
};

/// Reads NAME[=VALUE][@[drive+]START[+DURATION]]: "silent=state@5s+2s", "drop=0.01", "clock=1h@3s" … A bare number is
/// in seconds. Errors name what is wrong and list the faults that there are.
hal::Result<Fault> parse_fault(std::string_view text);

/// One line a fault: how it is written and what it does.
std::string fault_manual();

/// All faults of one robot's run, and the chance in them.
class FaultPlan : public FaultSchedule<Fault> {
 public:
  using FaultSchedule::FaultSchedule;

  /// What a message becomes on its way: nothing, itself, something else, twice itself, or it waits for the next of its
  /// channel. Messages of one way leave in the order of their times.
  void to_hub(const Datagram& message, std::vector<Datagram>& out);
  void to_robot(const Datagram& message, std::vector<Datagram>& out);

 private:
  struct Way {
    FaultKind mute, lose, twice, swap, late;
    std::map<std::string, Datagram> held{};
    hal::TimeNs last_at = 0;
  };
  void pass(Way& way, Datagram message, std::vector<Datagram>& out);
  bool is_mute(FaultKind kind, const std::string& channel, hal::TimeNs at) const;
  hal::TimeNs longest_ns(FaultKind kind, hal::TimeNs at) const;
  void damage(const std::string& channel, Bytes& data, hal::TimeNs at);

  Way out_{FaultKind::Silent, FaultKind::Drop, FaultKind::Double, FaultKind::Swap, FaultKind::Delay};
  Way in_{FaultKind::Deaf, FaultKind::Lose, FaultKind::Repeat, FaultKind::Overtake, FaultKind::Lag};
};

/// Does to the robot what concerns it alone. `new_session` is that of a restart.
void apply(const FaultPlan::Change& change, Eyebot& robot, std::int32_t new_session);

}  // namespace tandem::bridges::eyebot_emulator
