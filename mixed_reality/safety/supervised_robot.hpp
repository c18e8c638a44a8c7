// A real robot whose controller writes straight into its bridge's ports, with the safety table between them.
//
//   controller = type.construct(memory, bridge.robot(), params);
//   SupervisedRobot robot(bridge, …);            // when the controller has taken its ports
//   each tick:  if (robot.latch(tick, …)) controller step;  robot.commit(now);
#pragma once
#include <cstddef>
#include <memory>
#include <string>
#include <vector>

#include "bridges/robot_bridge.hpp"
#include "hal/log.hpp"
#include "mixed_reality/safety/battery_watch.hpp"
#include "mixed_reality/safety/flight_order_gate.hpp"
#include "mixed_reality/safety/supervisor.hpp"

namespace tandem::mixed_reality {

struct SupervisedParams {
  RearmParams rearm = {};
  hal::TimeNs tick_ns = 100 * hal::kNsPerMs;
  hal::TimeNs frozen_after_ns = hal::kNsPerSecond;  ///< two ticks that lie farther apart: the hub was frozen
};

/// The same table, ramp and re-arming for `tandem robot` as a twin has in `tandem run`, but for the pose, which nobody
/// knows here. Not thread-safe; `latch` and `commit` allocate nothing but for messages.
class SupervisedRobot {
 public:
  /// `bridge` must outlive this.
  SupervisedRobot(std::string id, bridges::RobotBridge& bridge, const SupervisedParams& params, hal::Log log);

  /// Takes over readings, stamped so that those of tick `tick` are as old as they are now, and judges.
  /// @returns whether the controller is to step.
  bool latch(hal::Tick tick, hal::TimeNs now);
  /// Sends what the controller wrote, as far as it may be. Its ports keep what it wrote.
  void commit(hal::TimeNs now) noexcept;

  /// Guardians have stopped the robot because this program did not run: noted by the next `latch`.
  void hub_was_frozen() noexcept { frozen_ = true; }
  /// Whether somebody would stop the robot if this program died; heeded by the next `latch`.
  void set_guarded(bool guarded) noexcept { guarded_ = guarded; }
  /// A person re-arms the robot.
  void rearm() noexcept { supervisor_.rearm(); }
  const Supervisor& supervisor() const noexcept { return supervisor_; }
  const Verdict& verdict() const noexcept { return supervisor_.verdict(); }
  /// Why it may not drive, for people: "a reading never came (ground)".
  std::string reason() const;

 private:
  struct Output {
    const hal::PortType* type;
    void* port;
  };
  struct Input {
    const hal::PortType* type;
    const hal::Reading* reading;
    bool came = false;
  };

  Conditions conditions(hal::TimeNs now) noexcept;
  const Input* missing() const noexcept;
  std::byte* kept(std::size_t output) noexcept { return kept_.get() + output * largest_; }
  void note();

  std::string id_;
  bridges::RobotBridge& bridge_;
  SupervisedParams params_;
  hal::Log log_;
  Supervisor supervisor_;
  BatteryWatch battery_watch_;
  FlightOrderGate orders_;
  std::vector<Output> outputs_;
  std::vector<Input> inputs_;
  const hal::Battery* battery_;        // null: it has none
  const hal::Positioning* position_;   // null: it does not know
  const hal::FlightState* flight_;     // null: it does not fly
  std::size_t largest_ = 0;            // of the outputs, in bytes
  std::unique_ptr<std::byte[]> kept_;  // what the controller wrote, while other commands leave
  hal::TimeNs last_ns_ = 0;
  bool frozen_ = false;
  bool guarded_ = true;
  bool landing_ = false;
  std::string_view noted_;
};

}  // namespace tandem::mixed_reality
