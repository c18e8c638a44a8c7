// A real robot among simulated ones: the entity that stands for it in the space, kept true in every tick.
#pragma once
#include <cstdint>
#include <memory>
#include <optional>
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
#include "mixed_reality/safety/battery_watch.hpp"
#include "mixed_reality/safety/flight_order_gate.hpp"
#include "mixed_reality/safety/supervisor.hpp"
#include "mixed_reality/time/moment.hpp"
#include "mixed_reality/tracking/commanded_motion.hpp"
#include "mixed_reality/tracking/delay_watch.hpp"
#include "mixed_reality/tracking/pose_source.hpp"
#include "mixed_reality/tracking/slip_watch.hpp"
#include "mixed_reality/twin/mechanisms.hpp"
#include "mixed_reality/twin/smooth_pose.hpp"
#include "mixed_reality/twin/twin_barrier.hpp"
#include "mixed_reality/twin/twin_entity.hpp"

namespace tandem::mixed_reality {

struct TwinParams {
  RearmParams rearm;
  hal::TimeNs pose_timeout_ns = 500 * hal::kNsPerMs;  ///< age from which a pose is stale
  hal::TimeNs frozen_after_ns = hal::kNsPerSecond;    ///< two ticks that lie farther apart: the hub was frozen
  double fence_ahead_s = 0.5;                         ///< how far ahead the arena's edge is looked for
  bool ask_battery = false;  ///< also where its controller does not read it, and its line is slow
  double coast_s = 2.0;      ///< in an outage the twin drives on as last commanded, at most for so long
};

/// Counted in the ticks of the run.
struct TwinCounts {
  std::uint64_t ticks_driving = 0;
  std::uint64_t ticks_held = 0;
  std::uint64_t stops = 0;  ///< times it was stopped by the safety table
  std::uint64_t rearms = 0;
  std::uint64_t fenced_ticks = 0;  ///< commands cut because they led out of the arena
  std::uint64_t intrusions = 0;    ///< times its twin came to stand in something virtual
  BarrierCounts barrier;
};

/// Keeps the entity `robot` of a space and a real robot one. Four calls a tick, in this order; none waits or
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
  /// Its wheels roll as another robot is seen to move: heeded by the next `latch`. `what` for people.
  void links_seem_swapped(const std::string& what) {
    swapped_ = true;
    note_incident(now_, what, true);
  }
  /// A person re-arms the robot.
  void rearm() noexcept { supervisor_.rearm(); }
  bool awaits_rearm() const noexcept { return supervisor_.awaits_rearm(); }
  /// Stops the robot now, without waiting for a tick (one that flies lands), and keeps it so until `arm`.
  void emergency_stop(hal::TimeNs monotonic_ns) noexcept;
  /// Ends an emergency stop: the robot settles, and drives by and by if all else is well.
  void arm() noexcept;
  bool emergency_stopped() const noexcept { return emergency_stop_; }
  /// Stops the robot now, for good: another one is to take its place.
  void retire(hal::TimeNs monotonic_ns) noexcept;
  /// Ends `retire`, because the other one never came. The robot stands until `arm`.
  void stay() noexcept;
  /// It took another one's place, and stands until `arm`.
  void wait_for_arming() noexcept { replaced_ = true; }
  bool awaits_arming() const noexcept { return emergency_stop_ || replaced_; }
  /// Before the run, with the phase Running for this robot alone: it drives so, whatever its controller says, as far as
  /// the safety table lets it; nothing: as its controller says.
  void steer(const std::optional<hal::WheelSpeeds>& wheels) noexcept { steered_ = wheels; }
  /// Takes over the newest readings and pose, and decides whether the robot may move; its controller is held if not.
  void latch(const Moment& now, RunPhase phase);
  /// The space's ports, which hold the twin's virtual readings, get the fused ones.
  void after_sense() noexcept;
  /// From now on commands go through this filter, which must outlive the twin.
  void join(BarrierFilter& filter) { barrier_ = std::make_unique<TwinBarrier>(filter, space_.kind(robot_)); }
  void leave() noexcept { barrier_.reset(); }
  /// Tells that filter what the controller commanded; then all robots' commands are decided upon at once.
  void offer(const Moment& now);
  /// Sends what the controller commanded, as far as it may be.
  void after_filter(const Moment& now);
  /// The real robot takes no part any more: the entity becomes one of the simulated ones. No other call follows.
  void let_go();

  /// What the robot did to the space in this tick: state and readings.
  const TwinEntity& entity() const noexcept { return entity_; }
  /// Their rows, and those of the commands that the robot was sent. They stay where they are as long as this does.
  void list(core::SpaceInputs& inputs) const;
  const std::string& id() const noexcept { return id_; }
  core::RobotId robot() const noexcept { return robot_; }
  bridges::RobotBridge& real() noexcept { return *real_; }
  const bridges::RobotBridge& real() const noexcept { return *real_; }
  /// Where the robot is in this tick, as well as is known: the tracked pose, carried on by what was commanded since it
  /// was taken. Its entity comes there without jumps.
  const core::Pose& pose() const noexcept { return pose_; }
  const PoseSource& poses() const noexcept { return *poses_; }
  hal::TimeNs pose_taken_ns() const noexcept { return pose_taken_ns_; }  ///< on the run's clock
  /// As its source said in the last `latch`.
  const TrackedPose& tracked() const noexcept { return tracked_; }
  /// The newest reading of all that the robot is asked for; null: none came yet.
  const hal::Reading* newest_reading() const noexcept;
  const hal::WheelEncoders* encoders() const noexcept { return encoders_; }  ///< null: nobody asks for them
  const hal::Battery* battery() const noexcept { return battery_; }          ///< null: it tells nothing
  const Verdict& verdict() const noexcept { return supervisor_.verdict(); }
  /// The wheel speeds last handed to the robot.
  const hal::WheelSpeeds& sent() const noexcept { return sent_; }
  /// By how much the filter changed the last command; 0: not at all.
  double changed_m_s() const noexcept { return barrier_ != nullptr ? barrier_->changed_m_s() : 0.0; }
  TwinCounts counts() const noexcept;
  /// Why the robot did not drive, in the order in which that came up: "12.3 s: link lost". The first few.
  const std::vector<std::string>& incidents() const noexcept { return incidents_; }

 private:
  struct Output {
    const hal::PortType* type;
    const void* port;  // in the space
    void* real;        // null: the robot has none such
    void* sent;        // as it last went to the robot
  };

  void track(const Moment& now, Conditions& conditions) noexcept;
  void note_track() noexcept;
  void tell_place() noexcept;
  core::Pose carried_on(const core::Pose& pose, hal::TimeNs from_ns, double for_s) const noexcept;
  void look_for_intrusions(const Moment& now);
  void note_incident(const Moment& now, const std::string& what, bool serious);
  void note(const Moment& now);
  void note_trespass(const Moment& now);
  void measure_delay(const Moment& now);
  bool may_move(const Moment& now) const noexcept;
  void send_commands(bool alive, const Moment& now);
  bool confine(const hal::PortType& type, void* command, const Moment& now) const noexcept;
  template <class Port, class Use>
  void each_confined(const Moment& now, Use&& use) const;
  void hold_back(const hal::PortType& type, void* command) const noexcept;

  core::Space& space_;
  core::RobotId robot_;
  std::string id_;
  std::unique_ptr<bridges::RobotBridge> real_;
  std::unique_ptr<PoseSource> poses_;
  TwinParams params_;
  const hal::Log& log_;
  hal::Fence fence_;        // for poses of the twin
  hal::Fence inner_fence_;  // for where its middle may go
  TwinEntity entity_;
  Mechanisms mechanisms_;
  bool told_place_;  // its controller took a positioning
  std::vector<Output> outputs_;
  std::vector<const hal::Reading*> readings_;  // that the robot is asked for
  void* real_wheels_;                          // null, as the next one: it has none
  void* real_task_;                            // of flight
  std::unique_ptr<std::max_align_t[]> told_;   // commands as they go to the robot
  Supervisor supervisor_;
  std::unique_ptr<SlipWatch> slip_;        // null: there is nothing to compare the wheels with
  const hal::Battery* battery_ = nullptr;  // null: it tells nothing
  BatteryWatch battery_watch_;
  const hal::FlightState* flight_ = nullptr;  // null: it does not fly
  FlightOrderGate orders_;
  std::unique_ptr<DelayWatch> delay_;             // null: it has no wheels, or does not tell what they roll
  const hal::WheelEncoders* encoders_ = nullptr;  // null: the same
  std::unique_ptr<CommandedMotion> motion_;       // null: it has no wheels
  std::uint64_t jumps_ = 0, slips_ = 0;           // of the pose, as far as they were judged
  bool swapped_ = false;
  TrackedPose tracked_;
  TrackRow track_;  // the same, for a record
  core::Pose pose_;
  SmoothPose smooth_;
  std::unique_ptr<TwinBarrier> barrier_;  // null: nothing keeps it from collisions
  hal::TimeNs heard_ns_ = 0;              // when it was last told something while it could hear
  Intrusion intrusion_;
  bool intruding_ = false;
  bool landing_ = false;  // it was told to, by us
  hal::WheelSpeeds sent_;
  hal::WheelSpeeds driven_;  // what it was last told while it could hear
  bool running_ = false;
  bool hub_was_frozen_ = false;
  bool guarded_ = true;
  bool emergency_stop_ = false;
  bool being_replaced_ = false, replaced_ = false;
  bool begun_ = false;  // the run has, and is not stopping
  std::optional<hal::WheelSpeeds> steered_;
  Moment now_;  // of the last `latch`
  hal::TimeNs last_latch_ns_ = 0;
  hal::TimeNs pose_taken_ns_ = 0;  // on the run's clock
  hal::Validity pose_validity_ = hal::Validity::Absent;
  std::string_view noted_;
  TwinCounts counts_;
  std::vector<std::string> incidents_;
};

}  // namespace tandem::mixed_reality
