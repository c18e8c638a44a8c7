// A real robot in a run: its bridge, the safety table, its identity, and the gate that its commands pass.
//
//   each tick:  robot.read(tick, now);  robot.judge(what others know, now);  controller steps if the verdict says so
//               robot.gate().prepare(…);  barrier between robots;  robot.send(…)
//
// The twin of a mixed run and `tandem robot` hold one each: what a robot may do is decided here for both.
#pragma once
#include <cstdint>
#include <memory>
#include <string>
#include <string_view>
#include <utility>
#include <vector>

#include "bridges/robot_bridge.hpp"
#include "mixed_reality/safety/battery_watch.hpp"
#include "mixed_reality/safety/command_gate.hpp"
#include "mixed_reality/safety/proof.hpp"
#include "mixed_reality/safety/supervisor.hpp"
#include "mixed_reality/time/moment.hpp"

namespace tandem::mixed_reality {

struct RealRobotParams {
  RearmParams rearm = {};
  hal::TimeNs frozen_after_ns = hal::kNsPerSecond;  ///< two ticks that lie farther apart: the hub was frozen
  bool ask_battery = false;  ///< also where its controller does not read it, and its line is slow
  bool all_wheels = true;    ///< its wheels are ordered to stand where its controller takes none
};

/// Joining: before the run, or in it and not armed yet. Held: it stands, and the verdict says why. Retired: another one
/// is to take its place.
enum class RobotState : std::uint8_t { Joining, Driving, Held, Retired };

/// Not thread-safe. No call waits; none allocates but for messages.
class RealRobot {
 public:
  /// After its controller has taken its ports. What `wanted` points to must outlive this.
  RealRobot(std::unique_ptr<bridges::RobotBridge> bridge, std::vector<WantedCommand> wanted,
            const RealRobotParams& params);

  /// Guardians have stopped the robots because this program did not run: heeded by the next `judge`.
  void hub_was_frozen() noexcept { hub_was_frozen_ = true; }
  /// Whether a guardian would stop the robot if this program died.
  void set_guarded(bool guarded) noexcept { guarded_ = guarded; }
  /// A person re-arms this robot, whichever answers now.
  void rearm();
  /// A person re-arms all robots that are proved to be those that were armed; nothing where this one is not.
  void rearm_if_proved();
  /// Stops the robot now, without waiting for a tick (one that flies lands), and keeps it so until `arm`.
  void emergency_stop(hal::TimeNs monotonic_ns) noexcept;
  /// A person arms this robot, whichever answers now: it settles, and drives by and by if all else is well. Not
  /// `named`: with all others, which ends an emergency stop, and leaves a robot standing that is not proved to be the
  /// one that was armed, or took another one's place.
  void arm(bool named = true);
  bool emergency_stopped() const noexcept { return emergency_stop_; }
  /// Stops the robot now, for good: another one is to take its place.
  void retire(hal::TimeNs monotonic_ns) noexcept;
  /// Ends `retire`, because the other one never came. The robot stands until `arm`.
  void stay() noexcept;
  /// It took another one's place, and stands until `arm`.
  void join_late() noexcept;

  /// Takes over readings, stamped from `origin_ns`. All are CLOCK_MONOTONIC.
  void read(hal::Tick tick, hal::TimeNs origin_ns, hal::TimeNs now_ns) noexcept;
  /// Decides what the robot may do; `outside` is what its bridge and this object do not know: phase, halts, pose.
  const Verdict& judge(Conditions outside, const Moment& now);
  /// Whether commands of this tick may leave: the verdict is young, and no person has stopped it since.
  bool may_move(hal::TimeNs monotonic_ns, hal::TimeNs verdict_lasts_ns) const noexcept;
  CommandGate& gate() noexcept { return gate_; }
  const CommandGate& gate() const noexcept { return gate_; }
  /// Hands the prepared commands to the robot, as far as they may be.
  template <class HoldBack>
  void send(bool alive, hal::TimeNs monotonic_ns, HoldBack&& hold_back) {
    gate_.send(alive, says_on_ground(flight_), supervisor_.verdict().land && begun_, monotonic_ns,
               std::forward<HoldBack>(hold_back));
  }

  RobotState state() const noexcept;
  const Verdict& verdict() const noexcept { return supervisor_.verdict(); }
  const Supervisor& supervisor() const noexcept { return supervisor_; }
  bool awaits_arming() const noexcept { return emergency_stop_ || replaced_; }
  bool awaits_rearm() const noexcept { return supervisor_.awaits_rearm(); }
  /// It waits for a person who names it: `rearm_if_proved` does not let it go.
  bool unproved() const noexcept { return supervisor_.unproved(); }
  /// Why it does not drive, for people: the table's word, which robot it is where that is in doubt, and what is wrong
  /// with its link or with `detail`, "link lost (the cable is out)".
  std::string reason(std::string_view detail = {}) const;

  bridges::RobotBridge& bridge() noexcept { return *bridge_; }
  const bridges::RobotBridge& bridge() const noexcept { return *bridge_; }
  const hal::Battery* battery() const noexcept { return battery_; }    ///< null: it tells nothing
  const hal::FlightState* flight() const noexcept { return flight_; }  ///< null: it does not fly
  hal::TimeNs judged_ns() const noexcept { return judged_ns_; }        ///< CLOCK_MONOTONIC; 0: never

 private:
  std::unique_ptr<bridges::RobotBridge> bridge_;
  RealRobotParams params_;
  Supervisor supervisor_;
  Proof proof_;
  CommandGate gate_;
  BatteryWatch battery_watch_;
  const hal::Battery* battery_ = nullptr;
  const hal::FlightState* flight_ = nullptr;
  hal::TimeNs judged_ns_ = 0;
  RunPhase phase_ = RunPhase::Waiting;
  bool begun_ = false;  // the run has, and is not stopping
  bool hub_was_frozen_ = false;
  bool guarded_ = true;
  bool emergency_stop_ = false;
  bool being_replaced_ = false, replaced_ = false;
};

}  // namespace tandem::mixed_reality
