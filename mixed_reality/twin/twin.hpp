// A real robot among simulated ones: the entity that stands for it in the space, kept true in every tick.
#pragma once
#include <cstdint>
#include <memory>
#include <string>
#include <string_view>
#include <vector>

#include "bridges/robot_bridge.hpp"
#include "core/space/space.hpp"
#include "hal/device/body_sensors.hpp"
#include "hal/device/flight.hpp"
#include "hal/device/wheels.hpp"
#include "hal/log.hpp"
#include "mixed_reality/fence/intrusion.hpp"
#include "mixed_reality/fusion/port_fusion.hpp"
#include "mixed_reality/safety/battery_watch.hpp"
#include "mixed_reality/safety/flight_order_gate.hpp"
#include "mixed_reality/safety/supervisor.hpp"
#include "mixed_reality/time/moment.hpp"
#include "mixed_reality/tracking/pose_source.hpp"
#include "mixed_reality/tracking/slip_watch.hpp"
#include "mixed_reality/twin/mechanisms.hpp"
#include "mixed_reality/twin/smooth_pose.hpp"

namespace tandem::mixed_reality {

struct TwinParams {
  RearmParams rearm;
  hal::TimeNs pose_timeout_ns = 500 * hal::kNsPerMs;  ///< age from which a pose is stale
  hal::TimeNs frozen_after_ns = hal::kNsPerSecond;    ///< two ticks that lie farther apart: the hub was frozen
  double fence_ahead_s = 0.5;                         ///< how far ahead the arena's edge is looked for
  double coast_s = 2.0;  ///< in an outage the twin drives on as last commanded, at most for so long
};

/// Counted in the ticks of the run.
struct TwinCounts {
  std::uint64_t ticks_driving = 0;
  std::uint64_t ticks_held = 0;
  std::uint64_t stops = 0;  ///< times it was stopped by the safety table
  std::uint64_t rearms = 0;
  std::uint64_t fenced_ticks = 0;  ///< commands cut because they led out of the arena
  std::uint64_t intrusions = 0;    ///< times its twin came to stand in something virtual
};

/// Keeps the entity `robot` of a space and a real robot one. Three calls a tick, in this order; none waits or
/// allocates, but that messages are logged when the verdict changes.
class Twin {
 public:
  /// The entity becomes external: engines do not move it, others bump into it. All but `real` must outlive this.
  Twin(core::Space& space, core::RobotId robot, std::unique_ptr<bridges::RobotBridge> real,
       std::unique_ptr<PoseSource> poses, const TwinParams& params, const hal::Log& log);

  /// The robots were stopped by others because this program did not run; to be told before the next `latch`.
  void hub_was_frozen() noexcept { hub_was_frozen_ = true; }
  /// Whether somebody would stop the robot if this program died; heeded by the next `latch`.
  void set_guarded(bool guarded) noexcept { guarded_ = guarded; }
  /// A person re-arms the robot.
  void rearm() noexcept { supervisor_.rearm(); }
  /// Takes over the newest readings and pose, and decides whether the robot may move; its controller is held if not.
  void latch(const Moment& now, RunPhase phase);
  /// The space's ports, which hold the twin's virtual readings, get the fused ones.
  void after_sense() noexcept;
  /// Sends what the controller commanded, as far as it may be.
  void after_filter(const Moment& now);
  /// The real robot takes no part any more: the entity becomes one of the simulated ones. No other call follows.
  void let_go();

  const std::string& id() const noexcept { return id_; }
  core::RobotId robot() const noexcept { return robot_; }
  bridges::RobotBridge& real() noexcept { return *real_; }
  const bridges::RobotBridge& real() const noexcept { return *real_; }
  /// Where the robot is in this tick, as well as is known: the tracked pose, carried on by what was commanded since it
  /// was taken. Its entity comes there without jumps.
  const core::Pose& pose() const noexcept { return pose_; }
  const PoseSource& poses() const noexcept { return *poses_; }
  const Verdict& verdict() const noexcept { return supervisor_.verdict(); }
  /// The wheel speeds last handed to the robot.
  const hal::WheelSpeeds& sent() const noexcept { return sent_; }
  TwinCounts counts() const noexcept;
  /// Why the robot did not drive, in the order in which that came up: "12.3 s: link lost". The first few.
  const std::vector<std::string>& incidents() const noexcept { return incidents_; }

 private:
  struct Output {
    const hal::PortType* type;
    const void* port;  // in the space
    void* real;        // null: the robot has none such
  };

  void track(const Moment& now, Conditions& conditions) noexcept;
  void tell_place() noexcept;
  core::Pose carried_on(const core::Pose& pose, double for_s) const noexcept;
  void look_for_intrusions(const Moment& now);
  void note_incident(const Moment& now, const std::string& what, bool serious);
  void hold(bool held);
  void note(const Moment& now);
  void send_commands(bool alive, const Moment& now);
  void confine(const hal::PortType& type, void* command, const Moment& now) noexcept;

  core::Space& space_;
  core::RobotId robot_;
  std::string id_;
  std::unique_ptr<bridges::RobotBridge> real_;
  std::unique_ptr<PoseSource> poses_;
  TwinParams params_;
  const hal::Log& log_;
  hal::Fence fence_;        // for poses of the twin
  hal::Fence inner_fence_;  // for where its middle may go
  PortFusion fusion_;
  Mechanisms mechanisms_;
  hal::Positioning* positioning_;  // the controller's; null: it took none
  std::vector<Output> outputs_;
  void* real_wheels_;                         // null, as the next one: it has none
  void* real_task_;                           // of flight
  std::unique_ptr<std::max_align_t[]> told_;  // a command as it goes to the robot; room for the largest
  Supervisor supervisor_;
  std::unique_ptr<SlipWatch> slip_;        // null: there is nothing to compare the wheels with
  const hal::Battery* battery_ = nullptr;  // null: it tells nothing
  BatteryWatch battery_watch_;
  const hal::FlightState* flight_ = nullptr;  // null: it does not fly
  FlightOrderGate orders_;
  std::uint64_t jumps_ = 0;  // of the pose, as far as they were judged
  core::Pose pose_;
  SmoothPose smooth_;
  Intrusion intrusion_;
  bool intruding_ = false;
  bool landing_ = false;  // it was told to, by us
  hal::WheelSpeeds sent_;
  hal::WheelSpeeds driven_;  // what it was last told while it could hear
  bool running_ = false;
  bool hub_was_frozen_ = false;
  bool guarded_ = true;
  bool held_ = false;  // by the safety table
  hal::TimeNs last_latch_ns_ = 0;
  hal::TimeNs pose_taken_ns_ = 0;  // on the run's clock
  hal::Validity pose_validity_ = hal::Validity::Absent;
  std::string_view noted_;
  TwinCounts counts_;
  std::vector<std::string> incidents_;
};

}  // namespace tandem::mixed_reality
